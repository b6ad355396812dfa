"""Coefficients of the limit friction law: numbers, errors, units and meanings.

What they are computed from is a floor above, in `model`."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
