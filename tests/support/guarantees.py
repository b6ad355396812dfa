"""What the mathematics guarantees of any solution, as numbers that may not exceed 1.

Each check takes a case and its solution and returns the violation relative to what is
allowed; NaN where there is nothing to compare with. Those that compare two solutions leave
out times inside slips, where a shift in time that is within the accuracy moves z by a well.
"""

import warnings
from collections.abc import Callable

import equinox as eqx
import numpy as np
from at_places import part_at
from hard_scenes import TIMES, Case, reflected, scaled

import frictionjax as fx
from frictionjax.wiggly.equation.status import FailedCells

ACCURACY = 1e-3
_SLIP = 0.05  # eps that z moves in 1% of a slip period inside a slip


def solved(case: Case, ts=TIMES, **options):
    """The case by the library's own choice of method."""
    return fx.solve(case.scene, case.eps, case.gamma, ts, ACCURACY, **options)


def outside_slips(case: Case) -> np.ndarray:
    """Which times are not inside a slip: z moves little in 1% of a slip period."""
    stiffness = case.numbers["support"]["stiffness"]
    speed, end = fastest(case) / stiffness, TIMES[-1]
    shift = 0.005 * case.eps / max(speed, case.eps / end)
    around = np.clip(np.concatenate([TIMES - shift, TIMES + shift]), 0, end)
    order = np.argsort(around)
    z = np.empty(around.size)
    z[order] = np.asarray(solved(case, around[order], dissipation=False).z)
    early, late = z.reshape(2, -1)
    return np.abs(late - early) <= _SLIP * case.eps


def found_load(case: Case, ts) -> np.ndarray:
    """The load at times, N."""
    return np.asarray(part_at(case.scene.load, ts))


def finite(case: Case, found) -> float:
    """Numbers where the status is good, and a status where they are not."""
    numbers = (found.z, found.dissipation, found.residual)
    whole = all(np.all(np.isfinite(np.asarray(v))) for v in numbers)
    return 0.0 if whole or not found.ok else np.inf


def dissipates(case: Case, found) -> float:
    """Dissipation never falls, and starts at 0."""
    spent = np.asarray(found.dissipation)
    fall = max(0.0, -float(np.diff(spent).min()), abs(float(spent[0])))
    return fall / (2 * ACCURACY * spent[-1] + 1e-12 * energy(case))


def energy(case: Case) -> float:
    """Energy of one slip, J."""
    law = fx.friction(case.scene)
    return case.eps * float(law.rho_plus - law.rho_minus)


def balance_closes(case: Case, found) -> float:
    """The energy-dissipation balance, which no solution violates.

    The status is not good above 0.05 of the energies. Typical scenes leave 1e-6; slips at
    gamma > 2 and eps < 1e-6 up to 0.04, which is in the cubics between the ends of steps:
    the dissipation was right to 1e-6 in the one looked at.
    """
    residual = float(found.residual[-1])
    scale = energy(case) + float(found.dissipation[-1])
    if residual < -1e-9 * scale:
        return np.inf
    return residual / (0.05 * scale)


def stays_near_the_strip(case: Case, found) -> float:
    """Lemma 7, with its constant: `dist(z, strip) <= d(0) + eps^gamma sup|l'|/phi^2`.

    Outside the strip of this eps (extremes of V_eps' instead of rho) the distance shrinks
    with `phi dist/eps^gamma` and grows no faster than the edges move, `|l'|/phi`.
    """
    low, high = strip_of_eps(case)
    z = np.asarray(found.z)
    outside = np.maximum(np.maximum(low - z, z - high), 0.0)
    return float(outside.max() / (outside[0] + lag(case) + 2e-3 * case.eps))


@eqx.filter_jit
def tip_forces(potential, tips, eps):
    return potential.tip_force(tips, eps)[0]


def strip_of_eps(case: Case) -> np.ndarray:
    """States in m that rest at this eps: the strip's edges at TIMES, (2, n)."""
    # 2048 missed the extremes of a steep surface by 5e-4: 0.01 eps on a soft support.
    tips = np.arange(2**15) / 2**15
    force = np.array(tip_forces(case.scene.potential, tips, np.asarray(case.eps)))
    return strip_between(case, force.max(), force.min())


def strip_between(case: Case, most: float, least: float) -> np.ndarray:
    """Edges of the strip at TIMES for extreme forces in N, m, (2, n)."""
    load = found_load(case, TIMES)
    return np.array([[inverse_force(case, f) for f in load - rho] for rho in (most, least)])


def lag(case: Case) -> float:
    """The most that z is outside its strip, in m, where it starts inside (Lemma 7)."""
    stiffness = case.numbers["support"]["stiffness"]
    return case.eps**case.gamma * fastest(case) / stiffness**2


def stays_near_the_limit(case: Case, found) -> float:
    """`|z_eps - z|` is at most a slip, a lag, and what the two strips are apart, twice.

    By comparison: z_eps slips only at an edge of its strip, by a period at most; z rests
    inside of its own, or is at that edge. (The start may be outside the strip of eps; the
    limit starts where its own strip is nearest.)
    """
    law = fx.friction(case.scene)
    own = strip_between(case, float(law.rho_plus), float(law.rho_minus))
    start = float(np.clip(case.numbers["z0"], *own[:, 0]))
    limit = np.asarray(fx.solve_limit(case.change(z0=start).scene, TIMES).z)
    apart = 1.01 * np.abs(strip_of_eps(case) - own).max()
    allowed = (1 + 2e-3) * case.eps + lag(case) + 2 * apart
    allowed += abs(case.numbers["z0"] - start)
    return float(np.abs(np.asarray(found.z) - limit).max() / allowed)


def fastest(case: Case) -> float:
    """sup |l'| in N/s, exact for these loads."""
    load = case.numbers["load"]
    if case.kind[2] == "piecewise":
        return float(np.abs(np.diff(load["values"]) / np.diff(load["times"])).max())
    factor = 2 * np.pi if case.kind[2] == "sine" else 4.0
    return abs(float(factor * load["amplitude"] / load["period"]))


def inverse_force(case: Case, force: float) -> float:
    """z with Phi'(z) = force, by bisection."""
    spring = case.numbers["support"]
    k, size = spring["stiffness"], spring["size"]
    if case.kind[1] == "spring":
        return force / k
    low, high = sorted((0.0, force / k))
    for _ in range(100):
        middle = 0.5 * (low + high)
        ahead = k * (middle + size * np.tanh(middle / size)) < force
        low, high = (middle, high) if ahead else (low, middle)
    return 0.5 * (low + high)


def _apart(case: Case, found, other, states: Callable, factor: float = 2.0) -> float:
    """Largest distance outside slips over `factor` accuracies.

    `states`: of the other solution, in the case's terms.
    """
    if not other.ok:
        return np.nan
    gaps = np.abs(np.asarray(found.z) - states(np.asarray(other.z))) / case.eps
    return _largest(case, other, gaps, outside_slips(case)) / (factor * ACCURACY)


def _largest(case: Case, other, gaps: np.ndarray, outside: np.ndarray) -> float:
    """Of the gaps at some times; infinite where a good status comes without numbers."""
    if finite(case, other) > 0:
        return np.inf
    return float(gaps[outside].max()) if outside.any() else np.nan


def is_accurate(case: Case, found) -> float:
    """Every slip at a thousandth of the tolerance gives the same."""
    tight = fx.solve(case.scene, case.eps, case.gamma, TIMES, 1e-6, "resolved")
    return _apart(case, found, tight, lambda z: z, 1.0)


def closes_brackets(case: Case, found) -> float:
    """Lanes from below and above have met within the accuracy."""
    gaps = np.asarray(found.stats["bracket"])[outside_slips(case)]
    return float(gaps.max()) / ACCURACY if gaps.size else np.nan


def knows_its_suprema(case: Case, found) -> float:
    """Largest deviations over [0, T] are those of every slip at a thousandth of the
    tolerance, whatever the times asked for, and no smaller than at some times.

    Of z in eps, or in the largest where that is more; of the dissipation in all of it. The
    start is moved into the strip.
    """
    law = fx.friction(case.scene)
    edges = strip_between(case, float(law.rho_plus), float(law.rho_minus))[:, 0]
    inside = case.change(z0=float(np.clip(case.numbers["z0"], *edges)))
    few = swept(inside, TIMES[[0, -1]], ACCURACY, "auto")
    every = swept(inside, TIMES, 1e-6, "resolved")
    if few.status != 0 or every.status != 0:
        return np.nan
    size = max(case.eps, float(every.sup_error))
    # Where next to nothing is dissipated, the limit's is what both are compared with.
    spent = max(float(every.dissipation[-1]), float(every.dissipation_error))
    seen = float(np.abs(every.z - every.z_limit).max())
    left = float(np.maximum(every.z_minus - every.z, every.z - every.z_plus).max())
    gaps = (
        (seen - few.sup_error) / size,
        (left - few.strip_excess) / size,
        abs(few.sup_error - every.sup_error) / size,
        abs(few.strip_excess - every.strip_excess) / size,
        abs(few.dissipation_error - every.dissipation_error) / spent,
    )
    return max(np.inf if np.isnan(gap) else float(gap) for gap in gaps) / ACCURACY


def swept(case: Case, ts, accuracy: float, method: str):
    """The case as the only cell of a sweep."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FailedCells)  # its status is asked for
        cells = fx.sweep(case.scene, case.eps, case.gamma, ts, accuracy, method)
    return cells.isel(eps=0, gamma=0)


def keeps_order(case: Case, found) -> float:
    """Solutions never cross: one that starts above stays above."""
    above = case.change(z0=case.numbers["z0"] + 0.3 * case.eps)
    other = solved(above)
    if not other.ok:
        return np.nan
    outside = outside_slips(case) & outside_slips(above)
    under = (np.asarray(found.z) - np.asarray(other.z)) / case.eps
    return _largest(case, other, np.maximum(under, 0.0), outside) / (2 * ACCURACY)


def knows_no_origin(case: Case, found) -> float:
    """A whole number of wells further on, with the load that goes with it."""
    if case.kind[1] != "spring" or case.kind[2] != "piecewise":
        return np.nan
    move = 7 * case.eps
    load = dict(case.numbers["load"])
    load["values"] = load["values"] + case.numbers["support"]["stiffness"] * move
    other = solved(case.change(z0=case.numbers["z0"] + move, load=load))
    return _apart(case, found, other, lambda z: z - move)


def knows_no_left(case: Case, found) -> float:
    """z -> -z, with the surface, the bristle and the load mirrored."""
    if case.kind[0] == "angular":
        return np.nan
    return _apart(case, found, solved(reflected(case)), np.negative)


def knows_no_units(case: Case, found, length: float = 3.7e-6, force: float = 2.9e-4):
    """Other units of length and force, and of time with them."""
    other, time = scaled(case, length, force)
    there = fx.solve(other.scene, other.eps, other.gamma, time * TIMES, ACCURACY)
    return _apart(case, found, there, lambda z: z / length)


ALONE: tuple[Callable, ...] = (
    finite,
    dissipates,
    balance_closes,
    stays_near_the_strip,
    stays_near_the_limit,
)
COMPARED: tuple[Callable, ...] = (
    is_accurate,
    closes_brackets,
    knows_its_suprema,
    keeps_order,
    knows_no_origin,
    knows_no_left,
    knows_no_units,
)
