"""The least bent surface in closed form, where nothing but its extreme slopes bounds it.

In NumPy: nothing to compile, so that a first fit of this kind takes no seconds.
"""

from functools import cache
from typing import Any

import jax.numpy as jnp
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
    ends = slopes_agreed(layout, task)
    if ends is None or uneven(ends) > kernel_ratio(layout.harmonics):
        return None
    waves = _waves(layout.harmonics, *ends)
    plus, minus = ends
    bound = free_energy(plus, minus, layout.harmonics)
    return for_all_starts(layout, task, starts, ends, waves, bound)


def slopes_agreed(layout: FitShape, task: FitTask) -> np.ndarray | None:
    """Slopes (omega_plus, -omega_minus) that all targets ask for.

    None where they ask for different ones, for some that a bristle does not follow, or
    where other things than slopes bound the surface.
    """
    if not (has_closed_form(layout) and isinstance(task.law, FixedLaw)):
        return None
    ends = _ends(task, task.law.known)
    if not (np.all(np.isfinite(ends)) and np.all(ends > 0)):
        return None
    left, steep = _left(task, ends)
    agreed = np.all(np.abs(left) <= SETTINGS.agreed) and steep < 1
    return ends if agreed else None


def uneven(ends: np.ndarray) -> float:
    """The larger of two slopes over the smaller one."""
    return float(np.max(ends / ends[::-1]))


def for_all_starts(
    layout: FitShape, task: FitTask, starts: int, ends: np.ndarray, waves: Any, bound: Any
) -> StartRuns | None:
    """A surface with the slopes agreed on; None where it is too sharp."""
    sharpest = _curvature(layout, waves)
    if not sharpest <= BARRIER_SETTINGS.row_margin * task.curvature:
        return None
    left, steep = _left(task, ends)
    room: Any = {"slopes": np.asarray(1 - steep)}
    if layout.sharp:
        room["curvature"] = 1 - sharpest / task.curvature
    return repeated(starts, _found(task, waves, ends, left, room, sharpest, bound))


def _left(task: FitTask, ends: np.ndarray) -> tuple[np.ndarray, float]:
    """What slopes leave of the targets, and how far they are of those followed."""
    law = task.law.known_at(jnp.zeros(0))
    plus, minus = task.slope * ends
    reached = coefficients_of(law, plus, minus, np)
    left = ((reached - np.asarray(task.coefficients)) * task.factors).ravel()
    return left, float(np.max(np.stack([plus / law.upper, minus / -law.lower])))


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
    task: FitTask, waves: Any, ends: Any, left: Any, room: Any, sharpest: Any, bound: Any
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
        bound=bound,
        misfit=np.sum(left**2, keepdims=True),
        ran=true,
    )
