"""The command line. Only click is imported at first: `--help` must not wait for JAX."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
