"""The least bent surface in closed form, where nothing but its extreme slopes bounds it.

In NumPy: nothing to compile, so that a first fit of this kind takes no seconds.
"""

from functools import cache
from typing import Any

import numpy as np

from ..common import FixedLaw, Geometry, coefficients_of, extreme_slopes
from .barrier import SETTINGS as BARRIER_SETTINGS
from .barrier import (
    FitShape,
    FitTask,
    Iterates,
    Reach,
    Settled,
    basis,
    free_energy,
    kernel_ratio,
)
from .multistart import StartRuns, repeated
from .settings import SETTINGS


def least_bent(layout: FitShape, task: FitTask, starts: int) -> StartRuns | None:
    """The optimum, by one start in a step, for all; None where no theorem gives it.

    It is (see `bending`) where the ratio of the extreme slopes flattens nothing, all
    targets agree on them, and the bounds hold with the margin of the rows.
    """
    if not (has_closed_form(layout) and isinstance(task.law, FixedLaw)):
        return None
    law = task.law.known
    ends = _ends(task, law)
    plus, minus = ends
    possible = np.all(np.isfinite(ends)) and np.all(ends > 0)
    if not (possible and np.max(ends / ends[::-1]) <= kernel_ratio(layout.harmonics)):
        return None
    reached = coefficients_of(law, task.slope * plus, task.slope * minus, np)
    left = ((reached - np.asarray(task.coefficients)) * task.factors).ravel()
    waves = _waves(layout.harmonics, plus, minus)
    sharpest = _curvature(layout, waves)
    steep = np.stack([plus * task.slope / law.upper, minus * task.slope / -law.lower])
    met = np.all(np.abs(left) <= SETTINGS.agreed) and np.all(steep < 1)
    if not (met and sharpest <= BARRIER_SETTINGS.row_margin * task.curvature):
        return None
    room = {"slopes": 1 - np.max(steep)}
    if layout.sharp:
        room["curvature"] = 1 - sharpest / task.curvature
    return repeated(starts, _found(task, waves, ends, left, room, sharpest))


def has_closed_form(layout: FitShape) -> bool:
    """Whether there may be one: bristles as they are, heights free, two waves or more."""
    return layout.free == 0 and not layout.high and layout.harmonics > 1


def _ends(task: FitTask, law: Geometry) -> np.ndarray:
    """Slopes (omega_plus, -omega_minus) that the first target asks for."""
    wanted = np.asarray(task.coefficients)[0]
    plus, minus = extreme_slopes(wanted[0], wanted[1], law.a[0], law.alpha[0])
    return np.array([plus, -minus]) / np.asarray(task.slope)


def _waves(harmonics: int, plus: Any, minus: Any) -> np.ndarray:
    """The combination of both kernels with `v(0) = plus`, `v(1/2) = -minus`."""
    sizes, signs, own, cross = _kernel(harmonics)
    determinant = own**2 - cross**2
    first = (own * plus + cross * minus) / determinant
    second = -(own * minus + cross * plus) / determinant
    return np.concatenate([sizes * (first + signs * second), np.zeros(harmonics)])


@cache
def _kernel(harmonics: int) -> tuple[np.ndarray, np.ndarray, float, float]:
    """`k(y)` by its waves, their signs at half a period, `k(0)` and `k(1/2)`."""
    n = np.arange(1, harmonics + 1)
    sizes, signs = np.sqrt(2.0) / (2 * np.pi * n), (-1.0) ** n
    return sizes, signs, float(np.sum(sizes**2)), float(np.sum(signs * sizes**2))


def _curvature(layout: FitShape, waves: np.ndarray) -> float:
    """Largest |v'| on the rows; 0 where nothing bounds it."""
    if not layout.sharp:
        return 0.0
    return float(np.max(np.abs(basis(layout.harmonics, layout.points, 1) @ waves)))


def _found(
    task: FitTask, waves: Any, ends: Any, left: Any, room: Any, sharpest: Any
) -> StartRuns:
    """One start's row: one step of Newton's method, from anywhere."""
    plus, minus = ends
    array: Any = np.asarray
    none, true = array([]), array(True)
    reach = Reach(plus, minus, sharpest, array(np.nan))
    path = Iterates(
        x=array([[*waves, plus, plus, minus, minus]]),
        loss=np.sum(waves**2, keepdims=True) / task.energy,
        weight=array([BARRIER_SETTINGS.last]),
        decrement=array([0.0]),
        steps=array(1),
        done=true,
    )
    return StartRuns(
        settled=Settled(waves, none, reach, ends, left, true),
        path=path,
        room=room,
        bound=free_energy(plus, minus, waves.size // 2),
        misfit=np.sum(left**2, keepdims=True),
        ran=true,
    )
