"""Where the load turns while tips are at a fold: a slip there hangs on very little.

Near a fold `E y' = b y^2 - d(t)`, E = eps^(gamma+1) G, b half the curvature in N, d what
the load lacks of the fold's force: the tip follows `y = -sqrt(d/b)`, and slips where the
load passes the fold by enough. Where it turns at the fold itself, d = c t^2, the other
branch is no further than `sqrt(E sqrt(c/b)/b)`, less than errors of steps at small eps: at
4e-5 and less, gamma = 1, tips slipped that do not, and were a well off from there on,
status OK.
"""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..._checks import Real
from ...loads import AbstractPull
from ...supports import AbstractSupport
from .landscape import WiggleFolds
from .settings import SETTINGS


class FoldsAtTurns(NamedTuple):
    """Those that tips come to at turns, (..., turns), as in `WiggleFolds`.

    `side`, of as many axes: 1 where the load turns down, -1 where it turns up, 0 where it
    does not.
    """

    state: Any
    force: Any
    bend: Any
    stretch: Any
    side: Any

    def lacks(self, support: AbstractSupport, loads: Any, eps: Any) -> tuple[Any, Any]:
        """The edge under `loads` in m, and what they lack in N of the fold nearest to it.

        The support's own stiffness moves the fold, and lifts it by the last term.
        """
        edge = support.state_of(loads - self.force)
        at = self.state + eps * ((edge - self.state) / eps).round()
        stiffness = support.stiffness_at(at) * eps * self.stretch
        lifted = self.side * stiffness**2 / (4 * self.bend)
        return edge, support.force(at) + self.force + lifted - loads

    def rounding(self, loads: Any, width: Any) -> Any:
        """How far rounding of forces moves tips at such a fold, squared, in periods."""
        return SETTINGS.cancelled * (abs(loads) + width) / self.bend


def folds_at(folds: WiggleFolds, side: Any) -> FoldsAtTurns:
    """Of folds (...,), the ones at turns to this `side`, (turns,)."""
    up = side > 0

    def of_each(plus: Any, minus: Any) -> Any:
        return plus[..., None] * up + minus[..., None] * ~up

    return FoldsAtTurns(
        state=of_each(folds.state_plus, folds.state_minus),
        force=of_each(folds.force_plus, folds.force_minus),
        bend=of_each(folds.bend_plus, folds.bend_minus) + SETTINGS.flat,
        stretch=of_each(folds.stretch_plus, folds.stretch_minus),
        side=side,
    )


def nearest_turn(
    load: AbstractPull,
    support: AbstractSupport,
    edges: Float[Array, " n"],
    folds: WiggleFolds,
    eps: Real,
) -> Real:
    """How near in periods the load's turns are to folds, whether tips are there or not.

    `edges`: turning points in s, the ends among them. As near as rounding goes: by how much
    the drag keeps branches apart is not looked at.
    """
    loads = jax.vmap(load)(edges)
    rise = jnp.sign(jnp.diff(loads))
    its = folds_at(folds, jnp.sign(rise[:-1] - rise[1:]))
    at = loads[1:-1]
    _, lacks = its.lacks(support, at, eps)
    rounding = its.rounding(at, folds.force_plus - folds.force_minus)
    apart = jnp.sqrt(jnp.abs(lacks) / its.bend + rounding)
    return jnp.min(jnp.where(its.side == 0, jnp.inf, apart), initial=jnp.inf)
