"""Steps through all gaps between samples, and what follows where the equation is linear."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from ..numerics import RADAU_PLACES, cubic
from .massive_steps import (
    MassiveEquation,
    MassiveSteps,
    SolvedStages,
    solved_stages,
)
from .sample_gaps import SampleGaps
from .settings import SETTINGS


class MassiveCourse(NamedTuple):
    """Steps, (m,), those of gap k from `kept[k]` on; `kept` has one entry more."""

    steps: MassiveSteps
    kept: Int[np.ndarray, " gaps1"]


class GapMoves(NamedTuple):
    """Of the starts of all steps, (m, 2), and the largest in each gap, (k,): by the tip in
    periods, and by the speed in units."""

    nodes: Float[np.ndarray, "m 2"]
    largest: Float[np.ndarray, " k"]


class LinearCourse(NamedTuple):
    """Near a course: `starts` of gaps and where they lead to, `reach`, (k, 2), and how that
    changes with the start, `whole` (k, 2, 2); `ends` and `change` of steps, (m, ...)."""

    found: SolvedStages
    starts: np.ndarray
    reach: np.ndarray
    whole: np.ndarray
    nodes: np.ndarray
    ends: np.ndarray
    change: np.ndarray

    def moves(self, course: MassiveCourse, starts: np.ndarray) -> GapMoves:
        """Of all steps, where gaps start elsewhere by so much."""
        kept, counts = course.kept, np.diff(course.kept)
        moved = np.zeros_like(self.nodes)
        moved[kept[:-1]] = starts
        for number in range(counts.max() - 1):
            here = kept[:-1][counts > number + 1] + number
            led = self.ends[here] + np.einsum("kij,kj->ki", self.change[here], moved[here])
            moved[here + 1] = led - self.nodes[here + 1]
        largest = np.maximum.reduceat(np.max(np.abs(moved), axis=1), kept[:-1])
        return GapMoves(moved, largest)

    def moved(
        self, course: MassiveCourse, moves: GapMoves, unit: float, trusted: float
    ) -> MassiveCourse:
        """The course after moves, those of a gap cut short beyond `trusted`."""
        steps, found = course.steps, self.found
        share = np.minimum(1.0, trusted / np.maximum(moves.largest, trusted))
        share = np.repeat(share, np.diff(course.kept))[:, None]
        tip, speed = moves.nodes[:, :1], unit * moves.nodes[:, 1:]
        tips = found.tips + found.tips_by_tip * tip + found.tips_by_speed * speed
        speeds = found.speeds + found.speeds_by_tip * tip + found.speeds_by_speed * speed
        steps = steps._replace(
            tip=steps.tip + (share * tip)[:, 0],
            speed=steps.speed + (share * speed)[:, 0],
            tips=steps.tips + share * (tips - steps.tips),
            speeds=steps.speeds + share * (speeds - steps.speeds),
        )
        return MassiveCourse(steps, course.kept)


def linear_near(
    equation: MassiveEquation, course: MassiveCourse, unit: float
) -> LinearCourse:
    """The equation along a course, linear in what moves it; speeds in units."""
    steps, kept = course
    found, scale = solved_stages(equation, steps), np.array([1.0, unit])
    nodes = np.stack([steps.tip, steps.speed], axis=1) / scale
    ends = np.stack([found.tips[:, 2], found.speeds[:, 2]], axis=1) / scale
    change = _change(found, unit)
    counts = np.diff(kept)
    whole = np.broadcast_to(np.eye(2), (counts.size, 2, 2)).copy()
    reach = nodes[kept[:-1]].copy()
    for number in range(counts.max()):
        rows = np.flatnonzero(counts > number)
        here = kept[rows] + number
        off = reach[rows] - nodes[here]
        reach[rows] = ends[here] + np.einsum("kij,kj->ki", change[here], off)
        whole[rows] = change[here] @ whole[rows]
    return LinearCourse(found, nodes[kept[:-1]], reach, whole, nodes, ends, change)


def _change(found: SolvedStages, unit: float) -> np.ndarray:
    """How ends change with starts, (m, 2, 2)."""
    tip = [found.tips_by_tip[:, 2], unit * found.tips_by_speed[:, 2]]
    speed = [found.speeds_by_tip[:, 2] / unit, found.speeds_by_speed[:, 2]]
    return np.moveaxis(np.array([tip, speed]), 2, 0)


def divided(gaps: SampleGaps, count: int) -> MassiveCourse:
    """`count` equal steps in each gap, on the cubics that join samples."""
    of = gaps.at(np.repeat(np.arange(gaps.start.size), count)[:, None])
    start = np.tile(np.arange(count) / count, gaps.start.size)
    shares = np.column_stack([start, start[:, None] + RADAU_PLACES / count])
    # Where a slip begins in a long gap the speed at its end would swing the cubic.
    most = np.maximum(3 * np.abs(of.rise), SETTINGS.swing)
    slopes = (np.clip(of.length * rate, -most, most) for rate in (of.rate0, of.rate1))
    tips = of.tip + cubic(shares, of.rise, *slopes)
    speeds = of.speed + shares * of.faster
    steps = MassiveSteps(
        start=of.start[:, 0] + start * of.length[:, 0],
        length=of.length[:, 0] / count,
        well=of.well[:, 0],
        tip=tips[:, 0],
        speed=speeds[:, 0],
        tips=tips[:, 1:],
        speeds=speeds[:, 1:],
    )
    return MassiveCourse(steps, count * np.arange(gaps.start.size + 1))


def joined_courses(
    parts: list[tuple[np.ndarray, MassiveCourse, np.ndarray]], counts: np.ndarray
) -> MassiveCourse:
    """One course from several: of each the numbers of some gaps, which, and its steps."""
    kept = np.append(0, np.cumsum(counts))
    shapes = [column.shape[1:] for column in parts[0][1].steps]
    whole = MassiveSteps(*(np.empty((kept[-1], *shape)) for shape in shapes))
    for rows, course, which in parts:
        if not rows.size:
            continue
        count = counts[rows[0]]
        there = (kept[rows][:, None] + np.arange(count)).ravel()
        for column, part in zip(whole, course.steps, strict=True):
            column[there] = part[np.repeat(which, count)]
    return MassiveCourse(whole, kept)


def _lagrange(shares: np.ndarray) -> np.ndarray:
    """Weights of the start and the stages of a step in the cubic through them."""
    known = np.append(0.0, RADAU_PLACES)
    rows = [np.prod([(shares - b) / (a - b) for b in known if b != a], 0) for a in known]
    return np.stack(rows)


_HALF = 0.5 * RADAU_PLACES
_HALVES = np.stack(
    [_lagrange(np.append(0.0, _HALF)), _lagrange(np.append(0.5, 0.5 + _HALF))]
)


def halved(course: MassiveCourse) -> MassiveCourse:
    """With every step in two, on the cubics through its stages."""
    steps, kept = course

    def both(starts: np.ndarray, stages: np.ndarray) -> np.ndarray:
        known = np.column_stack([starts, stages])
        return np.einsum("mi,hij->mhj", known, _HALVES).reshape(-1, 4)

    tips, speeds = both(steps.tip, steps.tips), both(steps.speed, steps.speeds)
    half = 0.5 * steps.length
    return MassiveCourse(
        MassiveSteps(
            start=np.stack([steps.start, steps.start + half], axis=1).ravel(),
            length=np.repeat(half, 2),
            well=np.repeat(steps.well, 2),
            tip=tips[:, 0],
            speed=speeds[:, 0],
            tips=tips[:, 1:],
            speeds=speeds[:, 1:],
        ),
        2 * kept,
    )
