"""With and against the nap: of rods at any angle, of loops, of a rod that turns over."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
