"""Inverse design: the surface and the bristle that give the friction you want.

`bristle`: a number of the bristle; `surface`: the profile; `slide`: both at finite eps;
`trace`: the surface behind a measured trace; `common`: what they share."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
