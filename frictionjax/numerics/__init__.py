"""What knows nothing of friction: roots, extrema, remainders, whole turns, columns."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
