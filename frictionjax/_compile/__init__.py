"""How programs are compiled, kept between processes and run: flags, threads, progress."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
