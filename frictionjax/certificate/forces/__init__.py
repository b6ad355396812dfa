"""The force on a tip along a curve, by the parts of a scene or by tables of them."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
