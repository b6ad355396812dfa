"""The equation itself: field, energy balance, landscape of a well, step plan, status."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
