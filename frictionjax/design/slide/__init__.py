"""Designs at finite eps: friction of a steady slide, and what gives a wanted one."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
