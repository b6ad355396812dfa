"""Solutions of the wiggly system from many states, each for a stretch of time."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
