"""Parts of scenes as tables of numbers: all scenes go through the same compiled programs.

A program depends on the classes of its arguments and on the shapes of their arrays. Parts
that people write have many; here they become a few, of a few sizes, to rounding.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
