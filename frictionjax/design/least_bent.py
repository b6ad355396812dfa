"""The least bent surface in closed form, where nothing but its extreme slopes bounds it."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool

from .bending import kernel_ratio
from .constraints import MARGIN, Layout, Unknowns, flat
from .extreme_slopes import reach
from .interior import LAST, Path, Task, residuals

_EXACT = 1e-12  # of the targets, weighted: rounding of coefficients


def has_closed_form(layout: Layout) -> bool:
    """Whether there may be one: bristles as they are, heights free, two waves or more."""
    return layout.free == 0 and not layout.high and layout.harmonics > 1


def least_bent(layout: Layout, task: Task) -> tuple[Array, Bool[Array, ""]]:
    """The surface as unknowns of the fit, and whether it is the optimum.

    It is (see `bending`) where the ratio of the extreme slopes flattens nothing, all
    targets agree on them, and the bounds hold with the margin of the rows.
    """
    none = jnp.zeros(0)
    plus, minus = _slopes(task)
    n = np.arange(1, layout.harmonics + 1)
    sizes = np.sqrt(2.0) / (2 * np.pi * n)
    signs = (-1.0) ** n
    own, cross = np.sum(sizes**2), np.sum(signs * sizes**2)
    determinant = own**2 - cross**2
    first = (own * plus + cross * minus) / determinant
    second = -(own * minus + cross * plus) / determinant
    cosines = sizes * (first + signs * second)
    waves = jnp.concatenate([cosines, jnp.zeros(layout.harmonics)])
    point = Unknowns(waves, jnp.stack([plus, plus]), jnp.stack([minus, minus]), none, none)
    uneven = jnp.maximum(plus / minus, minus / plus)
    left = residuals(task, plus, minus, none)
    known = (plus > 0) & (minus > 0) & (uneven <= kernel_ratio(layout.harmonics))
    known &= jnp.all(jnp.abs(left) <= _EXACT)
    known &= reach(waves).curvature <= MARGIN * task.curvature
    law = task.law.at(none)
    limits = jnp.all(law.upper > task.slope * plus) & jnp.all(
        -law.lower > task.slope * minus
    )
    return flat(point), known & limits


def _slopes(task: Task) -> tuple[Array, Array]:
    """`omega_plus` and `-omega_minus` that the first target asks for, in the task's units.

    Lemmas 2 and 3, inverted: `omega = mu/(1 - a mu)` with `mu = rho/alpha`.
    """
    law = task.law.at(jnp.zeros(0))
    a, alpha = law.a[0], law.alpha[0]
    share = task.coefficients[0] / alpha
    plus, minus = jnp.where(alpha > 0, share, share[::-1])
    return plus / (1 - a * plus) / task.slope, -minus / (1 - a * minus) / task.slope


def path_to(layout: Layout, task: Task, x: Array, kept: int) -> Path:
    """The way there: one step of Newton's method, from anywhere."""
    empty = jnp.full(kept, jnp.nan)
    energy = jnp.sum(layout.split(x).waves ** 2) / task.energy
    return Path(
        x=jnp.full((kept, x.size), jnp.nan).at[0].set(x),
        loss=empty.at[0].set(energy),
        weight=empty.at[0].set(LAST),
        decrement=empty.at[0].set(0.0),
        steps=jnp.asarray(1),
        done=jnp.asarray(True),
    )
