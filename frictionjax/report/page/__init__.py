"""Pages of HTML that need nothing beside them: their skeleton, texts, tables, pictures."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
