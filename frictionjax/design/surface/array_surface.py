"""The least bent surface under upright tips on one root, at phases of their own.

Their slopes add: together they see a wave of the surface times `c_n = sum_i weight_i
exp(2 pi i n offset_i)`. Turned by the phase of `c_n`, which bends nothing more, the waves
seen are those of the surface times `|c_n|`. So the problem is that of `barrier/bending.py`
with another kernel, `k(y) = sum_n 2 |c_n|^2 cos(2 pi n y)/(2 pi n)^2`, whose lowest place
need not be half a period.
"""

from typing import Any

import jax.numpy as jnp
import numpy as np

from ..._checks import require
from ...effects import RigidArray
from ..common import coefficients_of, extreme_slopes
from .barrier import SETTINGS as BARRIER_SETTINGS
from .barrier import FitShape, FitTask, Iterates, Reach, Settled
from .exchange import SETTINGS as EXCHANGE_SETTINGS
from .exchange import (
    SeenSlopes,
    bumps,
    least_bent_seen,
    most_uneven,
    phases_of,
    shares_seen,
    turned,
)
from .multistart import StartRuns, repeated
from .settings import SETTINGS


def require_plain(free: Any, radius: Any, amplitude: Any) -> None:
    """Raise `ValueError` for what such surfaces are not fitted with."""
    given = {"free": free, "smallest_radius": radius, "largest_amplitude": amplitude}
    for name, value in given.items():
        needs = "tips of effects.RigidArray at one phase of the surface, or none of this"
        require(value is None or not len(np.atleast_1d(value)), name, value, needs)


def fit_to_array(
    layout: FitShape, task: FitTask, array: RigidArray, starts: int
) -> StartRuns:
    """The optimum, which stands for all starts: nothing in it is random.

    Where no surface has the slopes asked for, the nearest that one has.
    """
    law = task.law.known_at(jnp.zeros(0))
    ends, weights = _ends(task, law)
    shares = shares_seen(array, layout.harmonics)
    seen = SeenSlopes(layout.harmonics, np.tile(np.abs(shares), 2))
    found, aim = least_bent_seen(seen, ends), ends
    ratio = largest_ratio(seen) if found is None else 1.0
    while found is None:  # once, but for rounding: any series can be as steep both ways
        aim = _nearest(ratio, ends, weights)
        found, ratio = least_bent_seen(seen, aim), 1 + SETTINGS.less_uneven * (ratio - 1)
    waves = turned(found.waves, phases_of(shares).conj())
    slopes = bumps(seen, found.waves)[1]
    reached = np.array([np.max(slopes), -np.min(slopes)])
    plus, minus = task.slope * reached
    rho = coefficients_of(law, plus, minus, np)
    left = ((rho - np.asarray(task.coefficients)) * task.factors).ravel()
    return repeated(starts, _row(task, waves, reached, ends, left, found.bound))


def _ends(task: FitTask, law: Any) -> tuple[np.ndarray, np.ndarray]:
    """Slopes (omega_plus, -omega_minus) that agree best with the targets, and weights."""
    wanted, factors = np.asarray(task.coefficients), np.asarray(task.factors)
    plus, minus = extreme_slopes(wanted[:, 0], wanted[:, 1], law.a, law.alpha)
    turns = (law.alpha < 0)[:, None]
    weights = np.where(turns, factors[:, ::-1], factors) * law.alpha[:, None]
    asked = np.stack([plus, -minus], axis=1) / np.asarray(task.slope)
    total = np.sum(weights**2, axis=0)
    return np.sum(weights**2 * asked, axis=0) / total, total


def _nearest(ratio: float, ends: Any, weights: Any) -> np.ndarray:
    """The slopes with this ratio, or 1 over it, that agree best with the targets."""
    plus, minus = ends
    share = ratio if plus > minus else 1 / ratio
    low = weights[0] * share * plus + weights[1] * minus
    low /= weights[0] * share**2 + weights[1]
    return np.array([share * low, low])


def ratio_seen(array: RigidArray, harmonics: int) -> float:
    """`largest_ratio` of a surface with this many harmonics."""
    shares = shares_seen(array, harmonics)
    return largest_ratio(SeenSlopes(harmonics, np.tile(np.abs(shares), 2)))


def largest_ratio(seen: SeenSlopes) -> float:
    """Of extreme slopes seen, that a surface has: all but the largest there is."""
    waves = most_uneven(seen.grid(EXCHANGE_SETTINGS.rows_ratio), seen.at(0.0))
    slopes = bumps(seen, waves)[1]
    return float(np.max(slopes) / -np.min(slopes))


def _row(
    task: FitTask, waves: Any, reached: Any, asked: Any, left: Any, bound: float
) -> StartRuns:
    """One start's row, as of one step."""
    array: Any = np.asarray
    plus, minus = reached
    energy = np.sum(waves**2)
    return StartRuns(
        settled=Settled(
            waves=waves,
            free=array([]),
            reach=Reach(plus, minus, array(np.nan), array(np.nan)),
            wanted=array(asked),
            residuals=left,
            met=array(np.allclose(reached, asked, rtol=SETTINGS.target_met, atol=0)),
        ),
        path=Iterates(
            x=array([[*waves, plus, plus, minus, minus]]),
            loss=array([energy / task.energy]),
            weight=array([BARRIER_SETTINGS.last]),
            decrement=array([0.0]),
            steps=array(1),
            done=array(True),
        ),
        room={"slopes": array(1.0)},
        bound=array(bound),
        misfit=np.sum(left**2, keepdims=True),
        ran=array(True),
    )
