"""Values between a lane from provably below and one from provably above.

`layout` says which stretches of time a cell measures, `requirements` how far back its lanes
must set off, `starts` from where, `brackets` which lanes that makes, `close` sends them off
until they have met, `finder` does the same along fast slides."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
