"""Missing heights: filled where the gap is short."""

import numpy as np

from .._checks import no_more, require
from ..profiles import find_period
from .samples import HeightSamples
from .settings import SETTINGS


def without_gaps(samples: HeightSamples) -> HeightSamples:
    """Samples of which none is missing: the ends cut off, short gaps filled by lines.

    Raises `ValueError` for a gap longer than a tenth of the period (and one sample), or
    a row of which more than a tenth is missing.
    """
    samples = _cut(samples)
    missing = np.isnan(samples.heights)
    if not missing.any():
        return samples
    row, sample = (int(i) for i in np.argwhere(missing)[0])
    place = samples.place(row, sample)
    share = missing.mean(axis=1)
    worst = int(np.argmax(share))
    where = samples.place(worst, int(np.argmax(missing[worst])))
    most = SETTINGS.most_missing
    needs = f"at most {most:.0%} of a row missing"
    require(share[worst] <= most, where, f"missing, with {share[worst]:.0%}", needs)
    filled = _interpolated(samples.x, samples.heights)
    longest = _require_short(samples, missing, filled)
    many = f"{int(missing.sum())} of {missing.size} heights missing, first {place}"
    note = f"{many}: filled by straight lines, over {longest} samples at most"
    return samples._replace(heights=filled, notes=[*samples.notes, note])


def _cut(samples: HeightSamples) -> HeightSamples:
    """Samples without those at either end that are missing in every row."""
    there = np.flatnonzero(~np.isnan(samples.heights).all(axis=0))
    require(there.size > 0, samples.place(0, 0), "missing", "heights")
    first, last = int(there[0]), int(there[-1]) + 1
    lost = samples.x.size - (last - first)
    if not lost:
        return samples
    note = f"samples missing at the ends, cut off: {lost}"
    x, heights = samples.x[first:last], samples.heights[:, first:last]
    lines, columns = (
        part[:, first:last] if part.size else part
        for part in (samples.lines, samples.columns)
    )
    return HeightSamples(x, heights, [*samples.notes, note], lines, columns)


def _interpolated(x: np.ndarray, heights: np.ndarray) -> np.ndarray:
    filled = heights.copy()
    for i in np.flatnonzero(np.isnan(filled).any(axis=1)):
        gone = np.isnan(filled[i])
        filled[i, gone] = np.interp(x[gone], x[~gone], filled[i, ~gone])
    return filled


def _require_short(samples: HeightSamples, missing: np.ndarray, filled: np.ndarray) -> int:
    """The longest gap in samples, which is short for the period of the heights."""
    row, start, count = _longest(missing)
    x = samples.x
    spacing = float(np.ptp(x)) / (x.size - 1)
    after, before = min(start + count, x.size - 1), max(start - 1, 0)
    gap = max(float(x[after] - x[before]) - spacing, count * spacing)
    if count > 1:
        period = find_period(x, filled, SETTINGS.harmonics)
        most = SETTINGS.longest_gap * period
        needs = f"a gap <= {no_more(most, 4)} m, a tenth of the period {period:.4g} m"
        said = f"{gap:.4g} m of missing heights"
        require(gap <= most, samples.place(row, start), said, needs)
    return count


def _longest(missing: np.ndarray) -> tuple[int, int, int]:
    """Row, first sample and count of the longest run of missing heights."""
    edges = np.diff(np.pad(missing, ((0, 0), (1, 1))).astype(int), axis=1)
    rows, starts = np.nonzero(edges == 1)
    counts = np.nonzero(edges == -1)[1] - starts
    best = int(np.argmax(counts))
    return int(rows[best]), int(starts[best]), int(counts[best])
