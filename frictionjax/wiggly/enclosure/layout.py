"""Which stretches of time each cell measures: all of them, or a few periods of slides."""

from typing import NamedTuple

import numpy as np

from ...numerics import rows_of
from .bracket_rows import BracketRows
from .brackets import Brackets
from .chains import chains_of
from .marching import BracketContext
from .requested_times import stops_at_times
from .requirements import Requirements
from .sampled_parts import CellSlides, Parts, inner_parts, sampled


class SampledPeriods(NamedTuple):
    """The inner part of a slide of one cell, of which only some periods are measured.

    `low`, `high`: its ends, s. `starts`, `ends`: times of the periods, s. `stops`: where
    they end, among the stops of the brackets. `way`: of the path from low to high, m.
    """

    cell: int
    piece: int
    low: float
    high: float
    way: float
    starts: np.ndarray
    ends: np.ndarray
    stops: np.ndarray


class Layout(NamedTuple):
    """Brackets of all cells, and what they are for.

    `chain`: for each cell, the stops that follow each other through everything that is
    not inside a slide, in time. `slides`: of all cells. `output` (cells, n): the stop at
    each requested time. `whole`: whether chain and slides cover [0, T].
    """

    brackets: Brackets
    chain: list[np.ndarray]
    slides: list[SampledPeriods]
    output: np.ndarray
    whole: bool


def lay_out(
    rounds: BracketContext, ts: np.ndarray, needs: Requirements, summed: bool = True
) -> Layout:
    """Brackets that give every requested time, and sums and extremes over [0, T].

    Segments are short enough for extremes good to the accuracy, in eps.

    Outside the inner parts of slides everything is measured, in tiles that follow each
    other; inside, some periods, and one bracket for each requested time. Where nothing is
    `summed`, only brackets with requested times are left.
    """
    summed = summed or not np.any(ts > 0)
    ground = rounds.ground
    slides = CellSlides(rounds.path, ground.eps, needs, ground.fast_slides)
    parts = inner_parts(slides)
    rows = BracketRows()
    chains = chains_of(slides, parts, ts, rounds.accuracy, summed, rows)
    periods = _sampled_periods(slides, parts if summed else rows_of(parts, slice(0)), rows)
    output = stops_at_times(slides, ts, chains.hit, rows)
    return Layout(
        brackets=rows.brackets(),
        chain=chains.stops,
        slides=periods,
        output=output,
        whole=summed,
    )


def _sampled_periods(
    slides: CellSlides, parts: Parts, rows: BracketRows
) -> list[SampledPeriods]:
    """A bracket for each period that is measured inside a slide."""
    who, starts, ends = sampled(slides, parts)
    lows, highs = (slides.path.states_at(times) for times in (parts.low, parts.high))
    periods = []
    for i in range(parts.cell.size):
        own = np.flatnonzero(who == i)
        one = np.ones(own.size, dtype=int)
        paired = ~slides.needs.settles[parts.cell[i]]
        stops = rows.add(parts.cell[i] * one, starts[own], paired, ends[own], one)
        period = SampledPeriods(
            cell=parts.cell[i],
            piece=parts.piece[i],
            low=parts.low[i],
            high=parts.high[i],
            way=highs[i] - lows[i],
            starts=starts[own],
            ends=ends[own],
            stops=stops,
        )
        periods.append(period)
    return periods
