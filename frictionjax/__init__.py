"""Directional dry friction as the limit of viscous motion over a wiggly surface.

Batched convergence studies of the systems of P. Gidoni and A. DeSimone, "On the genesis
of directional friction through bristle-like mediating elements" (2017), in JAX.

Names are imported when first used, so `import frictionjax` costs nothing.

A scene: `Scene` of parts from `profiles`, `bristles`, `supports`, `loads`, with `effects`;
`GivenPotential` in place of the first two; `potential`, `load_scene`, `save_scene`.

- Which friction? `friction`, `nap`, `steady_slide`, `friction_curve`.
- How does it move? `solve`, `solve_limit`, `mechanics`; with noise `ensemble`, `histogram`;
  two bristles and a spring that breathes: `crawler`.
- Can I trust it? `Status`, `certify`, `certify_limit`; `principle`, what moving costs.
- How fast is the limit reached? `sweep`, `study`.
- What does accuracy cost? `work_precision`, `predict_cost`, `fit_budget`, `order_cost`.
- Which effects does it call for? `explain`.
- Which surface or bristle do I need? `Target`, `fit_profile`, `fit_angle`, `fit_slide`,
  `fit_slide_profile`, `design_map`, `tolerance`, `check_design`.
- Which surface is behind a measurement? `measured`, `Trace`, `fit_trace`, `simulate_trace`.
- Pictures: `plot`, and `explore`, by sliders. Speed: `use_fast_cpu`, `keep_compiled`.

Docstrings end with an example. What stands in all of them, "..." being what is left out:

>>> import jax
>>> jax.config.update("jax_enable_x64", True)
>>> import numpy as np
>>> import frictionjax as fx
>>> scene = fx.Scene(
...     profile=fx.profiles.Sine(slope=0.1),
...     bristle=fx.bristles.SlantedSpring(1.0, rest_length=2.4, height=1.0, angle=1.0),
...     support=fx.supports.Spring(stiffness=1.0),
...     load=fx.loads.Sine(amplitude=1.05, period=3.0),
...     duration=3.0,
... )
"""

import lazy_loader

__getattr__, _names, __all__ = lazy_loader.attach_stub(__name__, __file__)

__version__ = "0.1.0"
__all__ += ["__version__"]


def __dir__() -> list[str]:
    return __all__
