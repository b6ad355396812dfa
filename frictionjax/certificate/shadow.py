"""A solution that stays close to a curve with mass: how far from it the curve is.

Solutions of a second-order equation are not ordered, and in slips they part: how far a
curve is from the one solution through its start says nothing. What is sought is the
solution that is nearest to all samples, in the sum of squares, by Newton's method. First in
every gap between two samples for itself, which says in how many steps; then in all of them
at once: a change `e_k` of a sample leads to one of the next, `e_(k+1) = A_k e_k + d_k`. At
the end a solution stands there, sample by sample, and the curve is no farther from one.
What its steps err by is what half as long ones change.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from .massive_course import (
    GapMoves,
    MassiveCourse,
    divided,
    halved,
    joined_courses,
    linear_near,
)
from .massive_steps import MassiveEquation
from .sample_gaps import SampleGaps
from .settings import SETTINGS


class Shadow(NamedTuple):
    """What leads from samples to a solution near them, (n, 2): by the tip in periods and
    the speed in units of speed. `doubt`: what steps may have moved the tip by, in periods.
    Where none was found all are inf; `resolved`: whether that is the curve's fault, and not
    that of gaps in which the steps do not agree."""

    moved: Float[np.ndarray, "n 2"]
    doubt: float
    resolved: bool


def shadow(equation: MassiveEquation, gaps: SampleGaps) -> Shadow:
    """The solution near samples."""
    with np.errstate(all="ignore"):  # far from solutions, which is told
        return _found(equation, gaps)


def _found(equation: MassiveEquation, gaps: SampleGaps) -> Shadow:
    course, resolved = _in_gaps(equation, gaps)
    coarse = _through_all(equation, gaps, course)
    if coarse is not None:
        fine = _through_all(equation, gaps, halved(coarse[0]))
        if fine is not None:
            change = np.max(np.abs(fine[1][:, 0] - coarse[1][:, 0]))
            doubt = float(change) / 3  # order 2, where 5 can be met
            return Shadow(fine[1], doubt, doubt <= SETTINGS.unsure)
    return Shadow(np.full((gaps.start.size + 1, 2), np.inf), np.inf, resolved)


def _in_gaps(equation: MassiveEquation, gaps: SampleGaps) -> tuple[MassiveCourse, bool]:
    """Solutions of all gaps, each for itself, in as many steps as it needs; and whether
    there are as many for all of them."""
    rows, count = np.arange(gaps.start.size), 1
    counts, parts = np.ones(rows.size, int), []
    room = max(SETTINGS.room, SETTINGS.room_a_gap * rows.size)
    while True:
        some = gaps.at(rows)
        one, at = _in_each(equation, some, divided(some, count))
        two, other = _in_each(equation, some, halved(one))
        apart = np.max(np.abs(other - at), axis=1)
        last = count >= SETTINGS.most or 4 * count * np.sum(apart > SETTINGS.local) > room
        near = (apart <= SETTINGS.local) | last
        parts.append((rows[near], two, near))
        counts[rows[near]] = 2 * count
        rows, count = rows[~near], 4 * count
        if not rows.size:
            return joined_courses(parts, counts), not (
                last and np.any(~(apart <= SETTINGS.unsure))
            )


def _in_each(
    equation: MassiveEquation, gaps: SampleGaps, course: MassiveCourse
) -> tuple[MassiveCourse, np.ndarray]:
    """The solution nearest to the two samples of each gap; what it differs from both by."""
    first, last = gaps.ends
    for _ in range(SETTINGS.rounds_in_gaps):
        near = linear_near(equation, course, gaps.unit)
        off = near.starts - first
        missed = near.reach - last - np.einsum("kij,kj->ki", near.whole, off)
        before, after = _least_alone(near.whole, missed)
        moves = near.moves(course, before - off)
        course = near.moved(course, moves, gaps.unit, SETTINGS.trusted)
        if not moves.largest.max() > SETTINGS.solved:
            break
    return course, np.concatenate([before, after], axis=1)


def _through_all(
    equation: MassiveEquation, gaps: SampleGaps, course: MassiveCourse
) -> tuple[MassiveCourse, np.ndarray] | None:
    """The solution nearest to all samples, and what it differs from them by; or None."""
    first, last = gaps.ends
    for _ in range(SETTINGS.rounds):
        near = linear_near(equation, course, gaps.unit)
        off = near.starts - first
        missed = near.reach - last - np.einsum("kij,kj->ki", near.whole, off)
        at = _least(near.whole, missed)
        if at is None:
            return None
        moves = near.moves(course, at[:-1] - off)
        largest = moves.largest.max()
        trusted = GapMoves(moves.nodes, np.full_like(moves.largest, largest))
        course = near.moved(course, trusted, gaps.unit, SETTINGS.trusted)
        if largest <= SETTINGS.solved:
            return course, at
        if not np.max(np.abs(off[:, 0])) < SETTINGS.hopeless:
            return None
    return None


def _least_alone(whole: np.ndarray, missed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The least changes at both ends of each gap, `after = whole before + missed`."""
    square = np.eye(2) + whole @ whole.transpose(0, 2, 1)
    (a, b), (c, d) = np.moveaxis(square, 0, 2)
    inverse = np.array([[d, -b], [-c, a]]) / (a * d - b * c)
    after = np.einsum("ijk,kj->ki", inverse, missed)
    before = -np.einsum("kij,ki->kj", whole, after)
    good = np.all(np.isfinite(before) & np.isfinite(after), axis=1)[:, None]
    return np.where(good, before, 0.0), np.where(good, after, np.inf)


def _least(whole: np.ndarray, missed: np.ndarray) -> np.ndarray | None:
    """The least e with `e_(k+1) = whole_k e_k + missed_k`, (k + 1, 2); None if none is."""
    from scipy.linalg import LinAlgError, solveh_banded

    count = missed.shape[0]
    square = np.eye(2) + whole @ whole.transpose(0, 2, 1)
    bands = np.zeros((4, 2 * count))
    bands[0] = np.stack([square[:, 0, 0], square[:, 1, 1]], axis=1).ravel()
    bands[1, 0::2] = square[:, 1, 0]
    bands[1, 1:-1:2] = -whole[1:, 0, 1]
    bands[2, 0:-2:2] = -whole[1:, 0, 0]
    bands[2, 1:-2:2] = -whole[1:, 1, 1]
    bands[3, 0:-3:2] = -whole[1:, 1, 0]
    try:
        weights = solveh_banded(bands, missed.ravel(), lower=True)
    except (LinAlgError, ValueError):  # not to be told from singular, or not finite
        return None
    weights = weights.reshape(count, 2)
    found = np.zeros((count + 1, 2))
    found[1:] = weights
    found[:-1] -= np.einsum("kij,ki->kj", whole, weights)
    return found
