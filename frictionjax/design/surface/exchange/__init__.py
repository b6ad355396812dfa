"""Surfaces by exchange: shortest vectors and linear programs whose rows are added."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
