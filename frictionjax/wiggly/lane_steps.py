"""How many steps lanes take for a well, foretold, and how many wells one may go through."""

import numpy as np

from .._checks import viscosity_of
from .enclosure import SETTINGS as ENCLOSURE_SETTINGS
from .equation import StepPlan
from .limit_path import Path
from .settings import SETTINGS


def drag_of(path: Path, eps: np.ndarray, gamma: np.ndarray) -> np.ndarray:
    """Of the fastest slide, over friction; less where tips follow only after it."""
    viscosity = np.asarray(viscosity_of(eps, gamma))
    drag = viscosity * path.speed / (path.rho_plus - path.rho_minus)
    follows, longs = viscosity[:, None] / path.stiffness, np.diff(path.edges)
    sudden = (path.direction != 0) & (follows > longs)
    waits = np.pad((path.direction == 0) & (follows < longs), ((0, 0), (0, 1)))[:, 1:]
    late = np.any(sudden & waits, axis=1)
    return np.where(late, np.minimum(drag, SETTINGS.behind), drag)


def steps_a_well(control: StepPlan, lag: np.ndarray, drag: np.ndarray) -> np.ndarray:
    """Of a lane on its way, about, (cells,); `lag` in wells, `drag` over friction."""
    smooth = np.minimum(-np.log10(drag), SETTINGS.smoothest)
    return np.exp(
        SETTINGS.constant
        - SETTINGS.by_tolerance * np.log10(control.tolerance)
        + SETTINGS.by_lag * np.log1p(lag)
        + SETTINGS.by_reach * np.log(SETTINGS.widest / np.asarray(control.reach))
        + SETTINGS.by_drag * smooth
        + SETTINGS.above_tenth * np.minimum(smooth, 1.0)
        + SETTINGS.above_one * np.minimum(smooth, 0.0)
    )


def tip_share(path: Path, eps: np.ndarray, gamma: np.ndarray) -> np.ndarray:
    """About what share of the path's way tips go themselves, (cells,).

    Of each slide what they come to before the path turns.
    """
    slides = np.flatnonzero(path.direction)
    way = np.abs(np.diff(path.states))[slides]
    turns = 1 + np.flatnonzero(np.diff(path.direction[slides]))
    ends = np.append(path.edges[slides[turns]], path.edges[-1])
    longs = ends[np.searchsorted(turns, np.arange(slides.size), side="right")]
    longs = longs - path.edges[slides]
    follows = np.asarray(viscosity_of(eps, gamma))[:, None] / path.stiffest
    return -np.expm1(-longs / follows) @ way / max(np.sum(way), 1e-300)


def affordable_wells(
    control: StepPlan, lag: np.ndarray, drag: np.ndarray, share: np.ndarray
) -> np.ndarray:
    """That one lane alone may go through, (cells,): more where tips stay far behind.

    `share`: of the path's wells that tips go through, in as many steps as in any others.
    """
    most = np.full(lag.shape, ENCLOSURE_SETTINGS.affordable)
    far, through = (steps_a_well(control, lag, d) for d in (np.maximum(drag, 1.0), 1.0))
    steps = np.maximum(far, share * through)
    lone = SETTINGS.lone_steps / steps
    known = (drag > 1) & np.isfinite(lone)  # at gamma = 400 nothing is
    return np.where(known, np.maximum(lone, most), most)
