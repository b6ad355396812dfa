"""Where the load turns while tips are at a fold: a slip there hangs on very little.

Near a fold `E y' = b y^2 - d(t)`, E = eps^(gamma+1) G, b half the curvature in N, d what
the load lacks of the fold's force: the tip follows `y = -sqrt(d/b)`, and slips
where the load passes the fold by enough. Where it turns at the fold itself, d = c t^2, the
other branch is no further than `sqrt(E sqrt(c/b)/b)`, less than errors of steps at small
eps: at 4e-5 and less, gamma = 1, tips slipped that do not, and were a well off from there
on, status OK.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from ..._compile import Interpreted, values_at
from ...supports import AbstractSupport
from ..equation import WiggleFolds
from .path import Path
from .settings import SETTINGS

_Cells = Float[np.ndarray, " cells"]


class _Folds(NamedTuple):
    """Those that tips come to at turns, (cells, turns), as in `WiggleFolds`.

    `side` (turns,): 1 or -1.
    """

    state: np.ndarray
    force: np.ndarray
    bend: np.ndarray
    stretch: np.ndarray
    side: np.ndarray


def nearness_at_turns(
    path: Path, folds: WiggleFolds, eps: _Cells, viscosity: _Cells, near: _Cells
) -> Float[np.ndarray, "cells kinks"]:
    """How near in periods tips come to a slip at each kink of the path; inf beyond `near`.

    No nearer than rounding of forces moves them: there the slip is that of a load that is
    off by its rounding.
    """
    found = np.full((eps.size, path.edges.size - 2), np.inf)
    rise = np.sign(np.diff(path.loads))
    side = np.sign(rise[:-1] - rise[1:])
    turns = np.flatnonzero(side) + 1
    if turns.size == 0:
        return found
    at, its = path.loads[turns], _folds_at(folds, side[turns - 1])
    edge, lacks = _from_folds(path.support, at, its, eps[:, None])
    # Tips rest before that fold only where the path is at the strip's edge.
    held = its.side * (path.states[turns] - edge) < SETTINGS.beside * eps[:, None]
    apart = np.sqrt(np.abs(lacks) / its.bend)
    some = np.nonzero(held & (apart < near[:, None]))
    cell, turn = some
    if cell.size == 0:
        return found
    drag = (viscosity * eps)[cell] * its.stretch[some]
    width = _widths(path, turns[turn], its.side[turn], its.bend[some], drag)
    rounding = SETTINGS.rounding * (np.abs(at) + path.width) / its.bend
    near_slips = np.sqrt(apart**2 + rounding)[some]
    found[cell, turns[turn] - 1] = np.hypot(near_slips, width)
    return found


def _folds_at(folds: WiggleFolds, side: np.ndarray) -> _Folds:
    def of_each(plus, minus) -> np.ndarray:
        return np.where(side > 0, np.asarray(plus)[:, None], np.asarray(minus)[:, None])

    return _Folds(
        state=of_each(folds.state_plus, folds.state_minus),
        force=of_each(folds.force_plus, folds.force_minus),
        bend=np.maximum(of_each(folds.bend_plus, folds.bend_minus), 1e-300),
        stretch=of_each(folds.stretch_plus, folds.stretch_minus),
        side=side,
    )


@Interpreted
def _from_folds(support: AbstractSupport, loads, folds: _Folds, eps):
    """The edge under `loads` in m, and what they lack in N of the fold nearest to it.

    The support's own stiffness moves the fold, and lifts it by the last term.
    """
    edge = support.state_of(loads - folds.force)
    at = folds.state + eps * ((edge - folds.state) / eps).round()
    stiffness = support.stiffness_at(at) * eps * folds.stretch
    lifted = folds.side * stiffness**2 / (4 * folds.bend)
    return edge, support.force(at) + folds.force + lifted - loads


def _widths(path: Path, turns, side, bend, drag) -> np.ndarray:
    """How near branches come by the drag alone, periods: `E/(b t)` where `t = E/sqrt(b d)`.

    By halves of the duration, on the flatter side of the turn: of kinks, plateaus and flat
    tops no second derivative tells anything.
    """
    begin, end = path.edges[0], path.edges[-1]
    after = (end - begin) * 2.0 ** -np.arange(1, SETTINGS.halves)
    own, which = np.unique(turns, return_inverse=True)
    times = path.edges[own][:, None, None] + after * np.array([[-1.0], [1.0]])
    beside = values_at(path.load, np.clip(times, begin, end).ravel()).reshape(times.shape)
    below = (path.loads[own][:, None, None] - beside)[which] * side[:, None, None]
    lacks = np.maximum(below, 0.0).min(axis=1)
    past = after * np.sqrt(bend[:, None] * lacks) > drag[:, None]
    # The shortest time that is past it; all of the duration where none is.
    last = np.count_nonzero(np.logical_and.accumulate(past, axis=1), axis=1)
    return drag / (bend * np.append(end - begin, after)[last])
