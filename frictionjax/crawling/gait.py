"""What both ways to a crawler's motion tell of it."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

_Column = Float[np.ndarray, " n"]


class Gait(NamedTuple):
    """At times, (n,): places of both feet in m, tension in N, dissipation in J.

    At finite eps also what is left of the balance of energies in J, how far in eps two runs
    are apart, and steps; `code`: a `Status`.
    """

    rear: _Column
    front: _Column
    tension: _Column
    dissipation: _Column
    residual: _Column | None = None
    error: float | None = None
    steps: int | None = None
    code: int = 0
