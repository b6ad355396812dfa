"""Rounds of brackets, which set off further back each time until they have closed."""

import numpy as np

from ..lanes import SegmentEnds, Segments
from .bracket_values import BracketValues
from .brackets import Brackets
from .closeness import meetings_at
from .layout import Layout
from .marching import BracketContext
from .requirements import Requirements, forgotten_after, resting_after
from .settings import SETTINGS
from .starts import CellBounds, lag_share, side_column, slow_share, starts_of


def close_brackets(
    rounds: BracketContext, layout: Layout, needs: Requirements
) -> tuple[BracketValues, np.ndarray]:
    """What rounds of brackets find, and the brackets that never closed."""
    brackets = layout.brackets
    size = brackets.stop.size
    values = np.full((len(SegmentEnds._fields), size), np.nan)
    segments = np.full((len(Segments._fields), size), np.nan)
    gap, how = np.full(size, np.inf), np.zeros(size, dtype=int)
    open_ = np.arange(brackets.cell.size)
    wells = run_ups(rounds, brackets, needs.run_up)
    back = np.zeros(wells.size)
    for _ in range(SETTINGS.rounds):
        open_brackets = brackets.chosen(open_)
        place = np.flatnonzero(np.isin(brackets.owner, open_))
        place = place[np.argsort(brackets.owner[place], kind="stable")]
        plan, ends, effort = rounds.run(open_brackets, wells[open_], back[open_])
        rounds = rounds._replace(effort=effort)
        speed = rounds.path.speed
        gaps = meetings_at(ends, plan.segments, plan.behind, plan.ahead, speed).gap
        where = plan.segments, plan.meet_behind, plan.meet_ahead, speed, plan.pace
        meets, shifts = meetings_at(ends, *where)
        # Stops that one lane alone has reached count as closed as their bracket's begin.
        alone = plan.ahead < 0
        gaps = np.where(alone, meets[open_brackets.owner], gaps)
        values[:, place] = np.stack([v[plan.behind] for v in ends])
        segments[:, place] = np.stack([v[plan.behind] for v in plan.segments])
        gap[place] = gaps
        how[place] = np.where(plan.known_start, 0, 1 + plan.from_slide)[open_brackets.owner]
        worst = np.zeros(open_brackets.cell.size)
        np.maximum.at(worst, open_brackets.owner, np.nan_to_num(gaps, nan=np.inf))
        # Lanes that met before a stop part again for a moment where it is at a slip: the
        # start is forgotten all the same, and the gap is reported as it is. Lanes from
        # close by have had steps of their own, which part them further: they go back once,
        # and so do those that set off from a fast slide where their bracket begins.
        far = (wells[open_] > SETTINGS.margin) & ~(plan.from_slide & (back[open_] < 1))
        met = np.maximum(meets, shifts)
        met = np.where(far, np.nan_to_num(met, nan=np.inf), np.inf)
        worst = np.minimum(worst, met)
        # At rest lanes forget as much again until the next slip.
        lone = needs.settles[open_brackets.cell]
        closed = SETTINGS.closed * np.where(lone, SETTINGS.closer, 1.0)
        open_ = open_[worst > closed * rounds.accuracy]
        if open_.size == 0:
            break
        wells[open_] = np.maximum(SETTINGS.earlier * wells[open_], SETTINGS.margin + 1)
        back[open_] = SETTINGS.earlier * np.maximum(back[open_], 1)
    result = BracketValues(
        arrivals=SegmentEnds._make(values),
        segments=Segments._make(segments),
        gap=gap,
        how=how,
        steps=rounds.effort.steps,
        rejected=rounds.effort.rejected,
    )
    return result, open_


def run_ups(rounds: BracketContext, brackets: Brackets, needed: np.ndarray) -> np.ndarray:
    """Wells that each bracket starts earlier: fewer where its slide is slow, (W,).

    Lags and memory are those of its direction at its speed, by the power of their lags;
    long ones as with the square of the speed: where folds are flat slides remember longer,
    and their brackets set off again if need be. (By that power too: looks after turns at
    gamma = 1/4, eps = 1e-8 went on for minutes, for 1 s.)
    """
    wells = needed[brackets.cell].astype(float)
    some = (wells > SETTINGS.some_memory) & np.isfinite(wells)
    if not some.any():
        return wells
    near = np.full(wells.size, SETTINGS.margin + 1.0)
    path = rounds.path
    starts = starts_of(
        path=path,
        ground=rounds.ground,
        cell=brackets.cell,
        begin=brackets.begin,
        wells=near,
        back=near,
        measured=False,
    )
    own, ground = brackets.cell, rounds.ground
    direction = path.direction[path.piece_of(starts.time)]
    power = np.where(wells > SETTINGS.long_memory, 2.0, ground.power(own, direction))
    share = slow_share(path, starts.time, power)
    slow = _slow_run_ups(ground, own, direction, share, rounds.accuracy)
    fast = starts.from_slide | starts.lagging
    # Others keep theirs: what they find must not depend on their neighbours.
    return np.where(some & ~fast, np.minimum(slow, wells), wells)


def _slow_run_ups(
    ground: CellBounds, cell: np.ndarray, direction: np.ndarray, share, accuracy: float
) -> np.ndarray:
    """Wells where there is this `share` of the lag and memory of a direction, (W,)."""
    own, eps = (cell, side_column(direction)), ground.eps[cell]
    lag = lag_share(ground, cell, share) * ground.lags[own] / eps
    memory = share * ground.memory(cell, direction)
    forgets, slow = forgotten_after(lag, memory, accuracy)
    return np.minimum(slow, resting_after(lag, np.inf, ground.shifts[own] / eps, forgets))
