"""Whether a given potential keeps its digits: neighbouring values that must agree."""

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import Real, require
from .._compile import in_chunks, once_a_scene
from ..numerics import slope_of
from .potentials import GivenPotential
from .settings import SETTINGS

# Fourth differences of noise are sqrt(70) times as large; of smooth functions next to none.
_WEIGHTS = np.array([1.0, -4.0, 6.0, -4.0, 1.0]) / np.sqrt(70.0)
_NODES, _SHARES = np.polynomial.legendre.leggauss(6)  # 64 harmonics: 1e-11 of a step


class Noises(NamedTuple):
    """What a given potential's values show, arrays over eps (n,).

    `w`, `force`: noise of W and W' over their ranges. `q`: of Q over `largest`, the largest
    |Q| and |Q'|; `change`: of eps Q' over the range of W', which is `range`. `seam`: what Q
    and Q' jump by at Y = 0, (n, 2).
    """

    w: np.ndarray
    force: np.ndarray
    q: np.ndarray
    change: np.ndarray
    largest: np.ndarray
    range: np.ndarray
    seam: np.ndarray


def noises(potential: GivenPotential, eps: np.ndarray) -> Noises:
    """Values of W and Q looked at, at every eps (n,)."""
    found = in_chunks(_noises, SETTINGS.noises, (potential,), (eps,))
    return Noises._make(found)


def require_digits(found: Noises, eps: np.ndarray) -> None:
    """Check that W, Q and their slopes are smooth to rounding at every eps (n,), rising.

    What a function changes by in 1/256 of a period must be the integral of its slope, and
    slopes at five phases 1e-6 of a period apart must lie on a smooth curve. The median in
    each sixteenth of a period counts, the largest of them, so that a place where W'' jumps
    does not, and digits lost on a part of the period do. (The median of the period let
    through a Q that has lost them on 40% of it.) What is written as a small difference
    of large numbers fails: Lemma 2's Q by hand, `(F(eps w) - F(0) - alpha eps w)/eps^2`,
    is noise of 1e-4 N/m at eps = 1e-6. (Values next to each other: of `1e8 + w - 1e8` they
    are the same number, without any noise.)

    Raises `ValueError` naming W or Q, and the smallest eps at which digits are lost.
    """
    needs = "smooth values: as written it is a small difference of large numbers"
    for name, noise, most in (
        ("potential.W: noise over range", found.w, SETTINGS.most_of_w),
        ("potential.W: noise of its slope over range", found.force, SETTINGS.most_of_force),
    ):
        require(noise[0] <= most, name, float(noise[0]), f"at most {most:g}, {needs}")
    lost = (found.q > SETTINGS.most_of_q) | (found.change > SETTINGS.most_of_force)
    if lost.any():
        worst, size = float(found.q[lost][0]), float(eps[lost][0])
        name = f"potential.Q at eps = {size:.6g}: noise over largest value"
        require(False, name, worst, f"at most {SETTINGS.most_of_q:g}, {needs}")


@once_a_scene
def _noises(potential: GivenPotential, eps: Float[Array, " n"]):
    """The fields of `Noises`, in their order."""
    values = jnp.ptp(jax.vmap(potential._leading)(_phases()))
    force = jnp.ptp(jax.vmap(slope_of(potential._leading))(_phases()))
    w = _of_values(potential._leading) / values
    slopes = _of_slopes(potential._leading) / force

    def at(size: Real) -> tuple[Array, ...]:
        def rest(phase: Real) -> Real:
            return potential._rest(size, phase)

        # With its slope: of what is lost whole nothing but 0 is left, and a slope.
        both = jax.vmap(jax.value_and_grad(rest))(_phases())
        largest = jnp.max(jnp.abs(jnp.stack(both)))
        lost = _of_values(rest) / jnp.where(largest > 0, largest, 1.0)
        change = size * _of_slopes(rest) / force
        return w, slopes, lost, change, largest, force, _at_seam(rest)

    return jax.lax.map(at, eps)


def _at_seam(rest: Callable[[Real], Real]) -> Float[Array, " 2"]:
    """What a function and its slope jump by, from just before Y = 1 to Y = 0."""
    ends = jnp.array([0.0, 1 - SETTINGS.inside, 1 - 2 * SETTINGS.inside])
    values, slopes = jax.vmap(jax.value_and_grad(rest))(ends)
    both = jnp.stack([values, slopes], axis=1)
    # From both places before it, a straight line: what is rounded there is in the noise.
    return jnp.abs(2 * both[1] - both[2] - both[0])


def _phases() -> Float[Array, " n"]:
    return (jnp.arange(SETTINGS.places) + 0.381966) / SETTINGS.places


def _of_values(fn: Callable[[Real], Real]) -> Real:
    """What changes between neighbouring places and slopes do not explain."""
    ends = jax.vmap(fn)(jnp.append(_phases(), _phases()[0] + 1))
    inside = _phases()[:, None] + (1 + _NODES[None]) / (2 * SETTINGS.places)
    slopes = jax.vmap(jax.vmap(slope_of(fn)))(inside) @ _SHARES / (2 * SETTINGS.places)
    return _worst_median(jnp.diff(ends) - slopes) / np.sqrt(2.0)


def _of_slopes(fn: Callable[[Real], Real]) -> Real:
    """Noise of a slope, from phases that are almost the same."""
    beside = _phases()[:, None] + SETTINGS.neighbours * jnp.arange(-2, 3)[None]
    slopes = jax.vmap(jax.vmap(slope_of(fn)))(beside)
    return _worst_median(slopes @ _WEIGHTS)


def _worst_median(left: Float[Array, " n"]) -> Real:
    """The largest median of the stretches of a period."""
    parts = jnp.abs(left).reshape(SETTINGS.stretches, -1)
    return jnp.max(jnp.median(parts, axis=1))
