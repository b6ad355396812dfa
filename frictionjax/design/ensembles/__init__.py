"""Friction of many designs: over two of their numbers, or as their numbers spread."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
