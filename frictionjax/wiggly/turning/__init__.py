"""Rods that turn over at finite eps: slides and turnings, one after the other.

Every slip is integrated: where a rod turns over its state jumps, and starts from below and
above would not meet.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
