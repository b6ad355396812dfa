"""Whether a sampled curve solves the wiggly system, judged from the scene alone.

Nothing of `wiggly` is imported here: a certificate is worth something because it comes
from elsewhere."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
