"""All cells eps x gamma of a scene as one data set.

By the library's own lanes (`wiggly`), or by any solver of diffrax in vmapped blocks."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
