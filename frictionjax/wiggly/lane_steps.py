"""How many steps lanes take for a well, foretold, and how many wells one may go through."""

import numpy as np

from .._checks import viscosity_of
from .enclosure import SETTINGS as ENCLOSURE_SETTINGS
from .equation import StepPlan
from .limit_path import Path
from .settings import SETTINGS

_QUARTERS = np.linspace(0.0, 1.0, 5)  # of a piece, on which tips may turn


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
    # Nothing drags where the limit never slides.
    smooth = np.minimum(-np.log10(np.maximum(drag, 1e-300)), SETTINGS.smoothest)
    return np.exp(
        SETTINGS.constant
        - SETTINGS.by_tolerance * np.log10(control.tolerance)
        + SETTINGS.by_lag * np.log1p(lag)
        + SETTINGS.by_reach * np.log(SETTINGS.widest / np.asarray(control.reach))
        + SETTINGS.by_drag * smooth
        + SETTINGS.above_tenth * np.minimum(smooth, 1.0)
        + SETTINGS.above_one * np.minimum(smooth, 0.0)
    )


def tip_share(path: Path, follows: float) -> float:
    """About what share of the path's way tips go themselves that take so long, in s, to.

    They do as `follows y' = path - y`, on each piece at its mean speed.
    """
    many = np.maximum(np.diff(path.edges) / follows, 1e-300)  # e-folds of a piece
    steps = np.diff(path.states)
    lost = -np.expm1(-many)
    behind = _driven(1 - lost, steps * lost / many)
    before = np.concatenate([[0.0], behind[:-1]])[:, None]
    part = many[:, None] * _QUARTERS
    gaps = before * np.exp(-part) - steps[:, None] * np.expm1(-part) / many[:, None]
    moves = np.diff(steps[:, None] * _QUARTERS - gaps, axis=1)
    return float(np.sum(np.abs(moves)) / max(path.travel[-1], 1e-300))


def _driven(kept: np.ndarray, pushed: np.ndarray) -> np.ndarray:
    """All `x[i] = kept[i] x[i-1] + pushed[i]` from 0, by doubling, (n,)."""
    reach = 1
    while reach < kept.size:
        pushed = pushed + kept * np.concatenate([np.zeros(reach), pushed[:-reach]])
        kept = kept * np.concatenate([np.zeros(reach), kept[:-reach]])
        reach *= 2
    return pushed


def affordable_wells(
    path: Path, control: StepPlan, lag: np.ndarray, eps: np.ndarray, gamma: np.ndarray
) -> np.ndarray:
    """That one lane alone may go through, (cells,): more where tips stay far behind.

    Wells that tips go through take as many steps there as any others.
    """
    most = np.full(lag.shape, ENCLOSURE_SETTINGS.affordable)
    drag = drag_of(path, eps, gamma)
    if not np.any(drag > 1):
        return most
    one, share = np.ones(lag.shape), np.zeros(lag.shape)
    for cell in np.flatnonzero(drag > 1):
        follows = viscosity_of(eps[cell], gamma[cell]) / path.stiffest
        share[cell] = tip_share(path, float(follows))
    far = steps_a_well(control, lag, np.maximum(drag, one))
    through = steps_a_well(control, lag, one)
    lone = SETTINGS.lone_steps / np.maximum(SETTINGS.guessed * far, share * through)
    known = (drag > 1) & np.isfinite(lone)  # at gamma = 400 nothing is
    return np.where(known, np.maximum(lone, most), most)
