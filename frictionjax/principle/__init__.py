"""The energy-dissipation principle (Sections 4 and 5), as functions of scenes and curves.

What friction and viscosity dissipate, and their duals: `R`, `R_star`, `R_eps`,
`R_eps_star`. What a motion under a force dissipates at least, in the limit and at finite
eps: `M` with its `K`, and `M_eps`. Along a whole curve: `D` and `D_eps`, of which the limit
is never more than what the wiggly systems leave: `D(z) <= liminf D_eps(z_eps)`.

>>> round(float(fx.principle.K(scene, 0.0)), 6)
0.064709
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
