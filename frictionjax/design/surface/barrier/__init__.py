"""Newton on a barrier, from inside the bounds, and a proof of how good its end is."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
