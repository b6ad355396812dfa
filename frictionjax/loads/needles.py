"""Places where a load is not smooth: kinks and cusps pass, jumps and poles do not."""

from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np

from .._checks import Real, require
from ..intervals import Enclosure
from .cells import Kind, LoadCells, LoadPoint, halves, needle
from .settings import SETTINGS

_NEARER = np.array(SETTINGS.nearer)
_SLOW = "a continuous function, slow enough to tell from one that jumps"


def kinks_of(cells: LoadCells, at: LoadPoint, duration: float) -> np.ndarray:
    """Where l' jumps: times on the piece to the right. Raises where l itself does."""
    sharp = np.flatnonzero(cells.kind == Kind.NEEDLE)
    if sharp.size == 0:
        return np.zeros(0)
    aside = SETTINGS.aside * needle(duration)
    starts = np.concatenate([[True], np.diff(cells.lo[sharp]) > aside])
    ends = np.append(starts[1:], True)
    lo, hi = cells.lo[sharp[starts]], cells.hi[sharp[ends]]
    before, after = np.maximum(lo - aside, 0.0), np.minimum(hi + aside, duration)
    (value0, slope0), (value1, slope1) = at(before), at(after)
    size, steepest = cells.size + 1e-300, np.fmax(np.abs(slope0), np.abs(slope1))
    _require_bounded(lo, hi, at, size, duration)
    length, change = after - before, np.abs(value1 - value0)
    unsure = change - np.maximum(
        SETTINGS.jump * size, SETTINGS.explained * steepest * length
    )
    jump = int(np.argmax(np.where(np.isnan(unsure), np.inf, unsure)))
    where = f"at t = {hi[jump]:.6g}, or changes so within {length[jump]:.2g} s"
    require(unsure[jump] <= 0, "load.fn", f"jumps by {change[jump]:.6g} {where}", _SLOW)
    least = SETTINGS.kink * size / duration + SETTINGS.kink_beside * steepest
    kink = ~(np.abs(slope1 - slope0) <= least)
    return hi[kink]


def _require_bounded(
    lo: np.ndarray, hi: np.ndarray, at: LoadPoint, size: float, duration: float
) -> None:
    """Check that values do not go on growing towards places, however close."""
    away = _NEARER[:, None] * (SETTINGS.aside * needle(duration))
    for side in (lo - away, hi + away):
        times = np.clip(side, 0.0, duration)
        values = at(times.ravel())[0].reshape(times.shape)
        with np.errstate(invalid="ignore"):
            steps = np.abs(np.diff(values, axis=0))
            grows = np.all(steps[1:] >= SETTINGS.grows * steps[:-1], axis=0)
            pole = grows & np.all(steps > SETTINGS.risen * size, axis=0)
        known = f"grows without bound at t = {lo[np.argmax(pole)]:.9g}"
        require(not pole.any(), "load.fn", known, "finite values on [0, duration]")


def require_numbers_inside(
    fn: Callable[[Real], Real], bounds: Enclosure, cells: LoadCells
) -> None:
    """Check places of which bounds do not exclude that they are no number, float by float.

    As that of 0/0, or of a branch for one time alone.
    """
    sharp = cells.kind == Kind.NEEDLE
    lo, hi = cells.lo[sharp], cells.hi[sharp]
    looked = 0
    while lo.size and looked < SETTINGS.most_stretches:
        looked += lo.size
        wide = _is_wide(bounds, lo, hi)
        lo, hi = lo[wide], hi[wide]
        ends = np.union1d(lo, hi)
        _require_numbers(fn, ends[_is_wide(bounds, ends, ends)])
        short = hi - lo <= np.spacing(lo)
        lo, hi = halves(lo[~short], hi[~short])


def _require_numbers(fn: Callable[[Real], Real], times: np.ndarray) -> None:
    if times.size == 0:
        return
    with jax.ensure_compile_time_eval():
        values = np.asarray(jax.vmap(lambda t: jnp.asarray(fn(t), float))(times))
    bad = ~np.isfinite(values)
    known = f"no finite number at t = {times[np.argmax(bad)]:.9g}"
    require(not bad.any(), "load.fn", known, "finite values on [0, duration]")


def _is_wide(bounds: Enclosure, lo: np.ndarray, hi: np.ndarray) -> np.ndarray:
    """Where a value may be unbounded, or none."""
    value = bounds(lo, hi).value
    return ~(np.isfinite(value.lo) & np.isfinite(value.hi))
