"""Tables of numbers in text files, with the units that their headings name; tables and
pictures that results show themselves as."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
