"""What every entry point asks of what it is given, and how it says so.

Arguments, grids of eps and gamma, the process around the library, what a part of a scene
is, what every result tells, enums whose members speak for people, files that are written
whole. Nothing here knows what friction is."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
