"""Inverse design: the surface and the bristle that give the friction you want."""
