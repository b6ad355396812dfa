"""Trajectories whose slips take no time: for viscosities far below what floats resolve.

Under a rising load the tip waits at the first place where the surface and the support hold
as much, `z(t) = inf {z >= z0: Phi'(z) + V_eps'(z) >= l(t)}`, and under a falling one
likewise; a slip turns all the energy it frees into heat. What viscosity adds is a delay at
each fold, of about `(eps^(1 + gamma))^(2/3)` s: 3% of a slip period at gamma = 1 and
eps = 1e-6. Times so near to a slip count as inside.
"""

import itertools

import numpy as np
import reference as ref
from entry import Entry, load_of, strip_of
from scipy.optimize import minimize_scalar

_WIDER = 12.0  # than what counts as inside a slip where viscosity is known: 6% of a period
_GRID = 400  # places in a well; crossings are then bisected


def _held(one: Entry, cos, sin, alpha: float, stiffness: float):
    """`Phi' + V_eps'` of a vertical spring at tips, wells."""
    n = np.arange(1, len(cos) + 1)[:, None]
    cos, sin = np.asarray(cos)[:, None], np.asarray(sin)[:, None]

    def held(y):
        a = ref.TWO_PI * n * np.mod(y, 1.0)
        height = np.sum(cos * np.cos(a) + sin * np.sin(a), axis=0)
        slope = np.sum(ref.TWO_PI * n * (sin * np.cos(a) - cos * np.sin(a)), axis=0)
        push = (alpha + stiffness * one.eps * height) * slope
        return one.system.stiffness * one.eps * y + push

    return held


def _bisected(held, low, high, load, sign):
    for _ in range(50):
        middle = 0.5 * (low + high)
        short = sign * (held(middle) - load) < 0
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return high


def _fold(held, sign: float) -> float:
    """Where in well 0 the tip is held hardest."""
    y = np.arange(4096) / 4096
    tilt = held(np.array([1.0])) - held(np.array([0.0]))
    best = y[np.argmax(sign * (held(y) - tilt * y))]

    def missing(offset):
        return -sign * held(np.array([best + offset]))[0]

    around = {"bounds": (-1 / 1024, 1 / 1024), "options": {"xatol": 1e-12}}
    return best + minimize_scalar(missing, method="bounded", **around).x


def _stretch(held, start: float, loads, sign: float, end: float):
    """Tips and energy per eps at `loads`, which rise where sign > 0."""
    low, high = min(start, end), max(start, end)
    y = np.linspace(low, high, max(2, round((high - low) * _GRID)))
    # The folds themselves: between samples 1e-6 N are missing, a hundred wells at 1e-8.
    folds = np.arange(np.floor(low), np.ceil(high)) + _fold(held, sign)
    y = np.union1d(y, folds[(folds > low) & (folds < high)])[:: int(sign)]
    count = y.size
    force = sign * held(y)
    reached = np.maximum.accumulate(force)
    free = np.maximum(reached, sign * loads[0]) - force
    spent = np.append(0.0, np.cumsum(0.5 * (free[1:] + free[:-1]) * abs(np.diff(y))))
    at = np.searchsorted(reached, sign * loads)
    inside = np.clip(at, 1, count - 1)
    tips = _bisected(held, y[inside - 1], y[inside], loads, sign)
    return np.where(at == 0, start, tips), spent[np.where(at == 0, 0, inside)]


def quasi_static(surface, alpha: float, stiffness: float = 1.0):
    """The reference of a vertical spring on a Fourier series."""

    def truth(one: Entry, ts: np.ndarray) -> ref.Reference:
        held = _held(one, *surface, alpha, stiffness)
        shift = _WIDER * ref.slip_shift(one.system, one.eps)
        ends = 0.0, one.system.duration
        around = np.clip(np.concatenate([ts - shift, ts, ts + shift]), *ends)
        wanted, place = np.unique(around, return_inverse=True)
        y, spent = _followed(one, held, wanted)
        early, now, late = (one.eps * y)[place].reshape(3, -1)
        inside = np.abs(late - early) > 0.05 * one.eps
        return ref.Reference(now, one.eps * spent[place].reshape(3, -1)[1], inside)

    return truth


def _followed(one: Entry, held, ts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Tips and energy per eps at `ts`, one stretch of the load after the other."""
    times, values = load_of(one.system)
    per_well, (low, high) = one.system.stiffness * one.eps, strip_of(one)
    y, spent = one.z0 / one.eps, 0.0
    tips, lost = np.full(ts.size, y), np.zeros(ts.size)
    # At the start the tip falls to where it is held.
    stops = [(0.0, values[0]), *zip(times, values, strict=True)]
    for (t, load), (t2, load2) in itertools.pairwise(stops):
        sign = np.sign(load2 - load) if t2 > t else np.sign(load2 - held(np.array([y]))[0])
        inside = (ts > t) & (ts <= t2)
        loads = np.append(np.interp(ts[inside], times, values), load2)
        if sign:
            end = (load2 - (high if sign > 0 else low)) / per_well + 1.5 * sign
            end = max(end, y + 1) if sign > 0 else min(end, y - 1)
            found, more = _stretch(held, y, np.append(load, loads), sign, end)
            found, more = found[1:], more[1:]
        else:
            found, more = np.full(loads.size, y), np.zeros(loads.size)
        tips[inside], lost[inside] = found[:-1], spent + more[:-1]
        y, spent = float(found[-1]), spent + float(more[-1])
    return tips, lost
