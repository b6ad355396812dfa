"""References to measure errors against, each checked by a second, different method."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from .limit_system import solve_limit
from .scene import Scene
from .wiggly.rodas5p import Rodas5P
from .wiggly.status import Status
from .wiggly.trajectory import solve

# Slips that lanes one after the other (0.4 ms each) and side by side (10 us) may take.
_ONE_BY_ONE, _EVERY = 2e4, 2e6
_SLIP_TIMES = 32  # over one whole slip period
_SHIFT, _MOVES = 0.005, 0.05  # a slip: that share of a period moves z by so many eps
_TIGHTER, _TIGHTEST = 1e-2, 1e-9


class Instants(NamedTuple):
    """Times at which a method is measured, s, sorted; `asked` and `slip` pick from them.

    `asked`: those the user named; `slip`: of a whole slip period, empty where nothing
    slides. `shift`: half the time around each in which a slip is looked for, 0 at rest.
    """

    ts: np.ndarray
    asked: np.ndarray
    slip: np.ndarray
    shift: np.ndarray


class Reference(NamedTuple):
    """States (m) and dissipation (J) at the instants, and how far they can be trusted.

    `error`: largest distance, outside slips, to a second method, in eps; `slip_error`:
    the mean over the slip period; `dissipation_error`: relative to the final value.
    `ways`: the two methods.
    """

    z: np.ndarray
    dissipation: np.ndarray
    in_slip: np.ndarray
    error: float
    slip_error: float
    end_error: float
    dissipation_error: float
    ways: str


def slips_of(scene: Scene, eps: float) -> float:
    """About how many slips a scene makes: the way of its limit in periods."""
    grid = np.linspace(0.0, float(scene.duration), 401)
    grid = np.union1d(grid, np.asarray(scene.turning_points()))
    return float(np.abs(np.diff(np.asarray(solve_limit(scene, grid).z))).sum() / eps)


def instants(scene: Scene, eps: float, ts: np.ndarray) -> Instants:
    """The user's times and those of a whole slip period in the middle of the last slide."""
    end = float(scene.duration)
    step = 1e-4 * end
    before, after = np.clip(ts - step, 0, end), np.clip(ts + step, 0, end)
    around = np.sort(np.concatenate([before, after]))
    z = np.asarray(solve_limit(scene, around).z)
    place = np.searchsorted(around, before), np.searchsorted(around, after)
    speed = np.abs(z[place[1]] - z[place[0]]) / (after - before)
    slides = speed * end > eps
    period = np.where(slides, eps / np.where(slides, speed, 1.0), 0.0)
    slip = np.zeros(0)
    if slides.any():
        last = np.flatnonzero(slides)
        # Away from both ends of the slide, where its speed changes.
        first = last[np.flatnonzero(np.diff(last) > 1)[-1] + 1] if _gaps(last) else last[0]
        middle = (first + last[-1]) // 2
        length = min(period[middle], end - ts[middle])
        slip = ts[middle] + length * (np.arange(_SLIP_TIMES) + 0.5) / _SLIP_TIMES
    every = np.union1d(ts, slip)
    shift = np.zeros(every.size)
    shift[np.searchsorted(every, ts)] = _SHIFT * period
    where = np.searchsorted(every, ts), np.searchsorted(every, slip)
    return Instants(every, *where, shift)


def _gaps(numbers: np.ndarray) -> bool:
    return bool((np.diff(numbers) > 1).any())


def reference(
    scene: Scene, eps: float, gamma: float, when: Instants, accuracy: float
) -> Reference:
    """The reference of one cell, a hundred times tighter than `accuracy`.

    The first of these that succeed: every slip one after the other through diffrax with
    Rodas5P; every slip in lanes; windows; windows ten times tighter still. The first is
    the reference, the second says how far it can be trusted: inf where there is none.
    """
    end = float(scene.duration)
    around = [np.clip(when.ts + sign * when.shift, 0, end) for sign in (-1, 0, 1)]
    order = np.argsort(np.concatenate(around), kind="stable")
    ts = np.concatenate(around)[order]
    tight = max(_TIGHTER * accuracy, _TIGHTEST)
    found = []
    for name, method, asked in _ways(slips_of(scene, eps), tight):
        one = solve(scene, eps, gamma, ts, asked, method)
        if one.status == Status.OK:
            back = np.argsort(order, kind="stable")
            z = np.asarray(one.z)[back].reshape(3, -1)
            spent = np.asarray(one.dissipation)[back].reshape(3, -1)[1]
            found.append((f"{name} at {asked:.0e}", z, spent))
        if len(found) == 2:
            break
    return _compared(when, eps, found)


def _ways(slips: float, tight: float) -> Iterator[tuple]:
    if slips <= _ONE_BY_ONE:
        yield "one slip after the other", Rodas5P(), tight
    if slips <= _EVERY:
        yield "every slip in lanes", "resolved", tight
    yield "windows", "windowed", tight
    yield "windows", "windowed", max(0.1 * tight, 0.1 * _TIGHTEST)


def _compared(when: Instants, eps: float, found: list) -> Reference:
    if not found:
        blank = np.full(when.ts.size, np.nan)
        nowhere = np.zeros(when.ts.size, dtype=bool)
        return Reference(blank, blank, nowhere, np.inf, np.inf, np.inf, np.inf, "none")
    ways = " against ".join(name for name, *_ in found)
    _, (before, z, after), spent = found[0]
    in_slip = np.abs(after - before) > _MOVES * eps
    if len(found) == 1:
        return Reference(z, spent, in_slip, np.inf, np.inf, np.inf, np.inf, ways)
    _, (_, other, _), other_spent = found[1]
    gaps = np.abs(other - z) / eps
    counted = gaps[when.asked][~in_slip[when.asked]]
    return Reference(
        z=z,
        dissipation=spent,
        in_slip=in_slip,
        error=float(counted.max(initial=0.0)),
        slip_error=float(gaps[when.slip].mean()) if when.slip.size else float("nan"),
        end_error=float(gaps[-1]),
        dissipation_error=relative_gap(other_spent, spent),
        ways=ways,
    )


def relative_gap(values: np.ndarray, true: np.ndarray) -> float:
    """Largest difference over the last true value; 0 where nothing was dissipated."""
    return float(np.abs(values - true).max() / true[-1]) if true[-1] > 0 else 0.0
