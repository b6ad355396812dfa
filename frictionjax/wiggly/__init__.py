"""The wiggly system (eq. 2.8) at finite eps: one trajectory, or all cells of a sweep.

From the bottom: `stepping` (step sizes, their control), `equation` (vector field, energies,
step plan), `rosenbrock` (the scheme), `sequential` (one traced trajectory, through
diffrax), `lanes` (many short integrations side by side), `limit_path` (what the limit does,
as a guide), `slip_map` (fast slides, well after well), `enclosure` (lanes from below and
above until they meet), `inertial` (tips with mass, every slip), `turning`
(rods that turn over), `sums` (values at stops,
integrals). `plan` says which way each cell goes, `batch` drives them all, and `trajectory`
is `fx.solve`."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
