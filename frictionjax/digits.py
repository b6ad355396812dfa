"""Whether a given potential keeps its digits: neighbouring values that must agree."""

from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .arguments import Real, require
from .extrema import slope_of
from .potentials import AbstractPotential, GivenPotential
from .programs import Program, in_chunks

_PLACES = 256  # of a period, off the grid of round phases
_STEP = 2.0**-20  # between neighbours: 64 harmonics bend by 1e-13 of themselves there
# Fourth differences of noise are sqrt(70) times as large; of smooth functions next to none.
_WEIGHTS = np.array([1.0, -4.0, 6.0, -4.0, 1.0]) / np.sqrt(70.0)
_NODES, _SHARES = np.polynomial.legendre.leggauss(6)  # 64 harmonics: 1e-11 of a step
_MOST_OF_W = 1e-7  # of the range of W: energies of wells, a slip has its digits then
_MOST_OF_FORCE = 1e-9  # of the range of W': slips would come at times of their own
_MOST_OF_Q = 1e-3  # of the largest |Q| and |Q'|: less is no Q any more
_TOGETHER = 8  # eps of one compiled call


def require_digits(potential: AbstractPotential, eps: np.ndarray) -> None:
    """Check that W, Q and their slopes are smooth to rounding at every eps (n,).

    What a function changes by in 1/256 of a period must be the integral of its slope, and
    slopes at five phases 1e-6 of a period apart must lie on a smooth curve; the median
    counts, so that a place where W'' jumps does not. What is written as a small difference
    of large numbers fails: Lemma 2's Q by hand, `(F(eps w) - F(0) - alpha eps w)/eps^2`,
    is noise of 1e-4 N/m at eps = 1e-6. (Values next to each other: of `1e8 + w - 1e8` they
    are the same number, without any noise.)

    Raises `ValueError` naming W or Q, and the smallest eps at which digits are lost.
    """
    if not isinstance(potential, GivenPotential):
        return
    found = in_chunks(_noises, _TOGETHER, (potential,), (np.sort(eps),))
    w, force, q, change = (np.asarray(part) for part in found)
    needs = "smooth values: as written it is a small difference of large numbers"
    for name, noise, most in (
        ("potential.W: noise over range", w, _MOST_OF_W),
        ("potential.W: noise of its slope over range", force, _MOST_OF_FORCE),
    ):
        require(noise[0] <= most, name, float(noise[0]), f"at most {most:g}, {needs}")
    lost = (q > _MOST_OF_Q) | (change > _MOST_OF_FORCE)
    if lost.any():
        worst, size = float(q[lost][0]), float(np.sort(eps)[lost][0])
        name = f"potential.Q at eps = {size:.6g}: noise over largest value"
        require(False, name, worst, f"at most {_MOST_OF_Q:g}, {needs}")


@Program
def _noises(potential: GivenPotential, eps: Float[Array, " n"]):
    """Noise of W, W' over their ranges, of Q over its size, of eps Q' over that of W'."""
    values = jnp.ptp(jax.vmap(potential._leading)(_phases()))
    force = jnp.ptp(jax.vmap(slope_of(potential._leading))(_phases()))
    w = _of_values(potential._leading) / values
    slopes = _of_slopes(potential._leading) / force

    def at(size: Real) -> tuple[Real, ...]:
        def rest(phase: Real) -> Real:
            return potential._rest(size, phase)

        # With its slope: of what is lost whole nothing but 0 is left, and a slope.
        both = jax.vmap(jax.value_and_grad(rest))(_phases())
        largest = jnp.max(jnp.abs(jnp.stack(both)))
        lost = _of_values(rest) / jnp.where(largest > 0, largest, 1.0)
        return w, slopes, lost, size * _of_slopes(rest) / force

    return jax.lax.map(at, eps)


def _phases() -> Float[Array, " n"]:
    return (jnp.arange(_PLACES) + 0.381966) / _PLACES


def _of_values(fn: Callable[[Real], Real]) -> Real:
    """Median of what changes between neighbouring places and slopes do not explain."""
    ends = jax.vmap(fn)(_phases())
    inside = _phases()[:, None] + (1 + _NODES) / (2 * _PLACES)
    slopes = jax.vmap(jax.vmap(slope_of(fn)))(inside) @ _SHARES / (2 * _PLACES)
    left = jnp.diff(ends) - slopes[:-1]
    return jnp.median(jnp.abs(left)) / np.sqrt(2.0)


def _of_slopes(fn: Callable[[Real], Real]) -> Real:
    """Median noise of a slope, from phases that are almost the same."""
    beside = _phases()[:, None] + _STEP * jnp.arange(-2, 3)
    slopes = jax.vmap(jax.vmap(slope_of(fn)))(beside)
    return jnp.median(jnp.abs(slopes @ _WEIGHTS))
