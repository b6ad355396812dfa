"""Orders of convergence: measured by regression, predicted by the laws of a slide."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
