"""The limit system: the play operator that friction is for eps -> 0 (eq. 2.3)."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
