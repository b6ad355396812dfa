"""Supports: the convex energy `Phi(z)` that pulls the bristle along.

- `Spring(stiffness)`: the linear spring of the paper.
- `Convex(energy_fn)`: your own uniformly convex energy; or derive from `AbstractSupport`.
"""

from .convex import Convex as Convex
from .spring import Spring as Spring
from .support import AbstractSupport as AbstractSupport
