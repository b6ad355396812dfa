"""Step sizes on a grid, and the control that chooses them, of lanes and of designs."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
