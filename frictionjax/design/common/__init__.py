"""What designs share: targets, free numbers, quantities; maps and tolerances of designs."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
