"""Rods that bend: the planar elastica, and the load at which a straight rod buckles."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
