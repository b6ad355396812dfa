"""The horizontal spring: its far end, its force, its energy, the power put in."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import Real
from .._compile import Interpreted
from ..loads import AbstractPull
from ..model import Scene
from ..supports import AbstractSupport, Spring
from ..tables import load_table

Rows = Float[Array, " n"] | Float[np.ndarray, " n"]


class SupportRows(NamedTuple):
    """Over times (n,): `load` l and `force = l - Phi'(z)` on the root in N, `energy` in J,
    `power` in W."""

    load: Rows
    force: Rows
    energy: Rows
    power: Rows


@Interpreted
def _rows(load: AbstractPull, support: AbstractSupport, ts: Any, z: Any) -> SupportRows:
    def at(t: Real, z: Real) -> SupportRows:
        pull, rate = load(t), load.slope(t)
        force = pull - support.force(z)
        if isinstance(support, Spring):
            k = support.stiffness
            return SupportRows(pull, force, 0.5 * force**2 / k, force * rate / k)
        energy = support.energy(z) - pull * z
        return SupportRows(pull, force, energy, -rate * z)

    return jax.vmap(at)(ts, z)


def support_rows(scene: Scene, ts: Rows, z: Rows) -> SupportRows:
    """Of a scene's support along a curve.

    Of a linear spring the energy is its own, `k_h/2 (q - L_h - u)^2`, and the power that of
    its far end, `force q'`. Of another one they are `Phi(z) - l z` and `-l' z`, which
    balance as well: the difference is a function of time alone.
    """
    return _rows(load_table(scene.load), scene.support, jnp.asarray(ts), jnp.asarray(z))
