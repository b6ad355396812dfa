"""Trajectories that share no line with the library: plain Python in SciPy's LSODA.

LSODA steps over wells when left alone; here no step may be longer than a few times the
duration of a slip, at tolerance 1e-11, nor carry the tip over a quarter of a well. Against
the library at accuracy 1e-9 it is within 1e-6 eps at eps = 1e-3 (8e-7), and within 2e-7
eps at eps = 1e-2.
"""

import itertools
import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import LSODA

TWO_PI = 2 * math.pi
_RESTARTS, _SHORT = 1000, 1e-4  # of a piece; first step of each over the longest


@dataclass(frozen=True)
class System:
    """Scalar functions of one scene, written by hand.

    `w(y)` gives (w, w'), `bristle(eta)` gives (A, A', F'), `force` is Phi', `load` is l,
    and `kinks` are the times at which l' jumps.
    """

    w: Callable[[float], tuple[float, float]]
    bristle: Callable[[float], tuple[float, float, float]]
    force: Callable[[float], float]
    load: Callable[[float], float]
    duration: float
    kinks: tuple[float, ...] = ()
    steepest: float = 0.1  # about max |V'|, for the length of a slip
    stiffness: float = 1.0
    rate: float = 2.0


@dataclass(frozen=True)
class Reference:
    """States (m) and dissipation (J) at `ts`, and which times are inside a slip."""

    z: np.ndarray
    dissipation: np.ndarray
    in_slip: np.ndarray


def series(cos: list[float], sin: list[float]):
    """w and w' of a Fourier series."""

    def w(y):
        height, slope = 0.0, 0.0
        for n, (c, s) in enumerate(zip(cos, sin, strict=True), start=1):
            a = TWO_PI * n * y
            height += c * math.cos(a) + s * math.sin(a)
            slope += TWO_PI * n * (s * math.cos(a) - c * math.sin(a))
        return height, slope

    return w


def sine(slope: float):
    """w and w' of a sine of the given slope."""
    return series([0.0], [slope / TWO_PI])


def _right_hand_side(system: System, eps: float, gamma: float):
    viscosity = eps**gamma

    def rates(t, state):
        height, slope = system.w(state[0])
        ahead, ahead_slope, climb = system.bristle(eps * height)
        stretch = 1 + ahead_slope * slope
        z = eps * state[0] + ahead
        driving = system.load(t) - system.force(z) - climb * slope / stretch
        return [driving / (viscosity * eps * stretch), driving**2 / viscosity]

    return rates


def _state(system: System, eps: float, y: np.ndarray) -> np.ndarray:
    return np.array([eps * v + system.bristle(eps * system.w(v)[0])[0] for v in y])


def _tip(system: System, eps: float, z: float) -> float:
    low, high = z / eps - 2, z / eps + 2
    for _ in range(200):
        middle = 0.5 * (low + high)
        if _state(system, eps, np.array([middle]))[0] < z:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def _piece(rates, start: float, end: float, state, times, longest: float):
    """States at `times`, increasing, the last of them `end`."""
    found, done, left = np.empty((len(times), 2)), 0, _RESTARTS
    solver = _lsoda(rates, start, state, end, longest)
    while solver.status == "running":
        before = solver.y[0]
        message = solver.step()
        if solver.status == "failed" and left:
            # Seen in the first step after a kink, where G is nearly 0.
            left -= 1
            where = solver.t, solver.y, end
            solver = _lsoda(rates, *where, longest, first_step=_SHORT * longest)
            continue
        assert solver.status != "failed", message
        assert abs(solver.y[0] - before) < 0.25, "a step over a quarter of a well"
        upto = int(np.searchsorted(times, solver.t, side="right"))
        if upto > done:
            found[done:upto] = solver.dense_output()(times[done:upto]).T
            done = upto
    return found


def _lsoda(rates, start: float, state, end: float, longest: float, **options) -> LSODA:
    return LSODA(
        rates, start, state, end, rtol=1e-11, atol=1e-11, max_step=longest, **options
    )


def slip_shift(system: System, eps: float) -> float:
    """Moving t by 0.5% of a slip period: where z moves by 0.05 eps, it is inside a slip."""
    return 0.005 * eps * system.stiffness / system.rate


def solve(
    system: System, eps: float, gamma: float, z0: float, ts, longest: float | None = None
) -> Reference:
    """Integrate piece by piece between kinks; ts increasing.

    `longest`: the longest step, s; four times about the duration of a slip where None.
    """
    ts = np.asarray(ts, float)
    if longest is None:
        longest = 4 * eps ** (1 + gamma) / system.steepest
    shift = slip_shift(system, eps)
    before = np.clip(ts - shift, 0, system.duration)
    after = np.clip(ts + shift, 0, system.duration)
    wanted = np.unique(np.concatenate([before, ts, after]))
    rates = _right_hand_side(system, eps, gamma)
    edges = [0.0, *system.kinks, system.duration]
    state, found = [_tip(system, eps, z0), 0.0], {0.0: (z0, 0.0)}
    for start, end in itertools.pairwise(edges):
        inside = wanted[(wanted > start) & (wanted <= end)]
        times = np.union1d(inside, [end])
        with warnings.catch_warnings():
            # LSODA's own of a failure, which `_piece` looks at.
            warnings.filterwarnings("ignore", "lsoda", UserWarning)
            states = _piece(rates, start, end, state, times, longest)
        z = _state(system, eps, states[:, 0])
        found |= dict(zip(times, zip(z, states[:, 1], strict=True), strict=True))
        state = list(states[-1])
    z = np.array([found[t][0] for t in ts])
    moved = [abs(found[a][0] - found[b][0]) for a, b in zip(before, after, strict=True)]
    return Reference(
        z=z,
        dissipation=np.array([found[t][1] for t in ts]),
        in_slip=np.array(moved) > 0.05 * eps,
    )
