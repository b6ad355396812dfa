"""The least bent surface under upright tips on one root, at phases of their own.

Their slopes add: together they see a wave of the surface times `c_n = sum_i weight_i
exp(2 pi i n offset_i)`. Turned by the phase of `c_n`, which bends nothing more, the waves
seen are those of the surface times `|c_n|`. So the problem is that of `barrier/bending.py`
with another kernel, `k(y) = sum_n 2 |c_n|^2 cos(2 pi n y)/(2 pi n)^2`, whose lowest place
need not be half a period. Let P = max v of the slopes v seen be at 0, -M = min v at s.

With P >= M (else the surface is turned over):

- Where the shortest waves with v(0) = P and -M <= v <= P reach -M, they are the optimum, of
  a convex problem: a least-distance problem, with rows added where the range is left.
- Else v(s) = -M has to be asked for too. Without the range that costs `(k0 (P^2 + M^2) +
  2 k(s) P M)/(k0^2 - k(s)^2)`, a lower bound. Places s are tried from the lowest bound on,
  until that of the next is above what was found: no other place is better (branch and
  bound). Then the best one is searched between its neighbours.
"""

from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from ..._checks import require
from ...effects import RigidArray
from ..common import coefficients_of, extreme_slopes
from .barrier import SETTINGS as BARRIER_SETTINGS
from .barrier import FitShape, FitTask, Iterates, Reach, Settled
from .exchange import SETTINGS as EXCHANGE_SETTINGS
from .exchange import (
    SeenSlopes,
    bumps,
    least_distance,
    most_uneven,
    phases_of,
    shares_seen,
    turned,
    with_ends_seen,
)
from .multistart import StartRuns, repeated
from .settings import SETTINGS


class _Found(NamedTuple):
    """Waves turned, and a lower bound of `int v'^2` of all with these slopes."""

    waves: Float[np.ndarray, " waves"]
    bound: float


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
    found, aim = _least_bent(seen, ends), ends
    ratio = largest_ratio(seen) if found is None else 1.0
    while found is None:  # once, but for rounding: any series can be as steep both ways
        aim = _nearest(ratio, ends, weights)
        found, ratio = _least_bent(seen, aim), 1 + SETTINGS.less_uneven * (ratio - 1)
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


def _least_bent(seen: SeenSlopes, ends: Any) -> _Found | None:
    """See above; None where no surface is seen to have these slopes."""
    plus, minus = ends
    if plus < minus:
        found = _least_bent(seen, (minus, plus))
        return None if found is None else found._replace(waves=-found.waves)
    rows = seen.grid(EXCHANGE_SETTINGS.rows_seen)
    waves = _within(seen, ends, None, rows)
    if waves is None:
        return None
    if np.min(rows @ waves) <= -minus * (1 - SETTINGS.reached):
        return _exactly(seen, ends, None, rows)
    place = _best_place(seen, ends, rows)
    return None if place is None else _exactly(seen, ends, place, rows)


def _best_place(seen: SeenSlopes, ends: Any, rows: np.ndarray) -> float | None:
    """Where the lowest slope is best, in periods from the highest."""
    count = len(rows)
    places = np.arange(1, count // 2 + 1) / count  # k is even
    bounds = _free_energies(seen, ends, places)
    best, where = np.inf, None
    for index in np.argsort(bounds):
        if bounds[index] >= best:
            break
        waves = _within(seen, ends, places[index], rows)
        if waves is not None and waves @ waves < best:
            best, where = float(waves @ waves), places[index]
    return None if where is None else _searched(seen, ends, where, best, rows)


def _free_energies(seen: SeenSlopes, ends: Any, places: np.ndarray) -> np.ndarray:
    plus, minus = ends
    top = seen.at(0.0)
    own, cross = top @ top, seen.at(places) @ top
    determinant = own**2 - cross**2
    # v(s) = -v(0), whatever v is.
    alone = determinant <= EXCHANGE_SETTINGS.impossible * own**2
    energies = own * (plus**2 + minus**2) + 2 * cross * plus * minus
    return np.where(alone, plus**2 / own, energies / np.where(alone, 1.0, determinant))


def _within(
    seen: SeenSlopes, ends: Any, place: float | None, rows: np.ndarray
) -> np.ndarray | None:
    """The shortest waves with P at 0, -M at the place, if any, and the range on rows."""
    plus, minus = ends
    fixed, least = seen.at(np.zeros(1)), [plus]
    if place is not None:
        fixed, least = np.concatenate([fixed, -seen.at([place])]), [plus, minus]
    inside = np.full(len(rows), -plus), np.full(len(rows), -minus)
    stacked = np.concatenate([fixed, -rows, rows])
    return least_distance(stacked, np.concatenate([least, *inside]))


def _searched(
    seen: SeenSlopes, ends: Any, place: float, known: float, rows: np.ndarray
) -> float:
    """The best place next to one with a known energy."""
    from scipy.optimize import minimize_scalar

    def energy(at: float) -> float:
        waves = _within(seen, ends, at, rows)
        return 2 * known if waves is None else float(waves @ waves)

    width = 1 / len(rows)
    near = place - width, place + width
    options = {"xatol": SETTINGS.place * width}
    found = minimize_scalar(energy, bounds=near, method="bounded", options=options)
    return float(found.x) if found.fun < known else place


def _exactly(
    seen: SeenSlopes, ends: Any, place: float | None, rows: np.ndarray
) -> _Found | None:
    """Rows added where the range is left, then both ends to rounding."""
    waves, over = _within(seen, ends, place, rows), EXCHANGE_SETTINGS.over * np.sum(ends)
    if waves is None:
        return None
    for _ in range(EXCHANGE_SETTINGS.additions):
        places, slopes = bumps(seen, waves)
        out = np.maximum(slopes - ends[0], -ends[1] - slopes) > over
        if not np.any(out):
            break
        rows = np.concatenate([rows, seen.at(places[out])])
        more = _within(seen, ends, place, rows)
        if more is None:  # no series, or rows so near to each other that none is found
            break
        waves = more
    bound = float(waves @ waves)
    return _Found(with_ends_seen(seen, waves, ends), bound)


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
