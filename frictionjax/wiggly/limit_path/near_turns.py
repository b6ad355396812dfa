"""How near tips come to a slip where the load turns: see `equation.turns_at_folds`."""

import numpy as np
from jaxtyping import Float

from ..._compile import Interpreted, values_at
from ..equation import FoldsAtTurns, WiggleFolds, folds_at
from .path import Path
from .settings import SETTINGS

_Cells = Float[np.ndarray, " cells"]
_lacks = Interpreted(FoldsAtTurns.lacks)


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
    at, its = path.loads[None, turns], folds_at(folds, side[None, turns - 1])
    edge, lacks = _lacks(its, path.support, at, eps[:, None])
    # Tips rest before that fold only where the path is at the strip's edge.
    held = its.side * (path.states[turns] - edge) < SETTINGS.beside * eps[:, None]
    # Not divided: straight flanks have no bend.
    some = np.nonzero(held & (np.abs(lacks) < near[:, None] ** 2 * its.bend))
    cell, turn = some
    if cell.size == 0:
        return found
    drag = (viscosity * eps)[cell] * its.stretch[some]
    width = _widths(path, turns[turn], its.side[0, turn], its.bend[some], drag)
    apart = np.abs(lacks[some]) / its.bend[some]
    apart += np.broadcast_to(its.rounding(at, path.width), lacks.shape)[some]
    found[cell, turns[turn] - 1] = np.sqrt(apart + width**2)
    return found


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
