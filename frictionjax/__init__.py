"""Directional dry friction as the limit of viscous motion over a wiggly surface.

Batched convergence studies of the systems of P. Gidoni and A. DeSimone, "On the genesis
of directional friction through bristle-like mediating elements" (2017), in JAX.

Names are imported when first used, so `import frictionjax` costs nothing. `__init__.pyi`
lists them.
"""

import lazy_loader

__getattr__, _names, __all__ = lazy_loader.attach_stub(__name__, __file__)

__version__ = "0.1.0"
__all__ += ["__version__"]


def __dir__() -> list[str]:
    return __all__
