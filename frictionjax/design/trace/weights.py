"""What a trace says of a surface, phase by phase, and what it does not."""

from typing import NamedTuple

import numpy as np

from .settings import SETTINGS


class TraceIdentifiability(NamedTuple):
    """What a trace determines of the slope `w'`.

    `phases` y in periods, (256,). `slope`: w' there. `standard_error`: of `slope`, without
    any prior: the larger of that of the series with its number of harmonics, and of
    `local`: the smallest slope that a bump of half the shortest wave anywhere around y
    must have to change the trace by one standard deviation in all; and of these the
    largest within a quarter of a bump's width. `visited`: whether a
    used sample has its tip within half a bump's width of y. `determined`: where a phase is
    visited and the error within the share asked for of half the range of w'. (Phases that
    tips only rush through change when a slip ends: to first order that is much, but
    surfaces far apart do the same.) `singular_values`: of the derivative of
    all used samples (in standard deviations) by cos and sin; `directions`: its right
    singular vectors, rows, best seen first. `rank`: directions seen to within a tenth of
    the size of the coefficients. `covariance`: of cos and sin, without any prior;
    directions that are not seen have variances too large to mean anything.
    """

    phases: np.ndarray
    slope: np.ndarray
    standard_error: np.ndarray
    local: np.ndarray
    determined: np.ndarray
    visited: np.ndarray
    singular_values: np.ndarray
    directions: np.ndarray
    rank: int
    covariance: np.ndarray

    @property
    def intervals(self) -> np.ndarray:
        """Phases determined, (intervals, 2); one that holds 0 begins below 0."""
        return intervals_of(self.determined)

    @property
    def share(self) -> float:
        """Share of the period that is determined."""
        return float(np.mean(self.determined))


def slopes_by(phases: np.ndarray, harmonics: int) -> np.ndarray:
    """`w'` at phases by cos and sin, (phases, unknowns)."""
    turns = 2 * np.pi * np.arange(1, harmonics + 1)
    angle = np.outer(phases, turns)
    return np.concatenate([-turns * np.sin(angle), turns * np.cos(angle)], axis=1)


def intervals_of(determined: np.ndarray) -> np.ndarray:
    """Runs of true values on a circle of phases, as (begin, end)."""
    count = determined.size
    if determined.all():
        return np.array([[0.0, 1.0]])
    edges = np.diff(determined.astype(int), prepend=int(determined[-1]))
    begin, end = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    if begin.size and end[0] <= begin[0]:
        begin = np.append(begin[-1] - count, begin[:-1])
    return np.stack([begin - 0.5, end - 0.5], axis=1) / count


def bumps_of(harmonics: int) -> tuple[np.ndarray, float]:
    """Centres of local bumps and their width: half the shortest wave, overlapping."""
    count = 4 * harmonics
    return np.arange(count) / count, 0.5 / harmonics


def identify(
    numbers: np.ndarray,
    by: np.ndarray,
    by_bumps: np.ndarray,
    tips: np.ndarray,
    within: float,
) -> TraceIdentifiability:
    """Judge by derivatives of used samples, in standard deviations.

    `by`: (unknowns, samples); `by_bumps`: (bumps, samples); `tips`: phases of the samples.
    """
    harmonics = numbers.size // 2
    phases = np.arange(SETTINGS.phases) / SETTINGS.phases
    known = slopes_by(phases, harmonics)
    _, values, directions = np.linalg.svd(by.T, full_matrices=True)
    seen = np.zeros(numbers.size)
    seen[: values.size] = values
    floor = max(SETTINGS.unseen * seen[0] ** 2, 1e-300)
    variance = 1 / np.maximum(seen**2, floor)
    series = np.sqrt(np.sum((known @ directions.T) ** 2 * variance, axis=1))
    centres, width = bumps_of(harmonics)
    with np.errstate(divide="ignore"):
        alone = 1 / np.linalg.norm(by_bumps, axis=1)
    distance = np.abs(_around(phases[:, None] - centres))
    local = np.max(np.where(distance <= SETTINGS.reach * width, alone, 0.0), axis=1)
    dip = int(np.ceil(SETTINGS.dip * width * SETTINGS.phases))
    error = _without_dips(np.maximum(series, local), dip)
    slope = known @ numbers
    size = float(np.linalg.norm(numbers))
    near = np.abs(_around(phases[:, None] - tips)) <= 0.5 * width
    visited = np.any(near, axis=1)
    return TraceIdentifiability(
        phases=phases,
        slope=slope,
        standard_error=error,
        local=local,
        determined=visited & (error <= within * 0.5 * np.ptp(slope)),
        visited=visited,
        singular_values=seen,
        directions=directions,
        rank=int(np.sum(seen * SETTINGS.seen * size > 1)),
        covariance=(directions.T * variance) @ directions,
    )


def _without_dips(error: np.ndarray, reach: int) -> np.ndarray:
    """The largest within so many phases, on a circle."""
    return np.max([np.roll(error, shift) for shift in range(-reach, reach + 1)], axis=0)


def _around(difference: np.ndarray) -> np.ndarray:
    return difference - np.round(difference)
