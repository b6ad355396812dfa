"""Rounds of windows through the lanes, further back each time until brackets close."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..._compile import WORKERS, crew
from ...model import Scene
from ..equation import Status
from ..lanes import SETTINGS as LANE_SETTINGS
from ..lanes import LaneCells, Lanes, LaneScene, SegmentEnds, Segments, Sums, march
from ..limit_path import Path, states_at
from ..rosenbrock import Tableau
from .bracket_values import BracketValues
from .brackets import BracketPlan, Brackets, plan_brackets
from .closeness import gaps_of, shifts_of
from .layout import Layout
from .requirements import Requirements
from .settings import SETTINGS
from .starts import CellBounds, Starts, slow_share, starts_of

Report = Callable[[float], None]


def _seats(count: int, seats: int) -> np.ndarray:
    """Seats dealt there and back, so that none gets all the lanes behind of brackets."""
    row, seat = np.divmod(np.arange(count), seats)
    return np.where(row % 2 == 0, seat, seats - 1 - seat)


def _batches(work: np.ndarray, workers: int) -> int:
    """Batches of jobs, as often as a report is wanted and lanes do not idle.

    They do where a batch has less than two jobs a lane, or is done in hardly more time than
    its longest takes. (Every slip of 48 cells, the tiles of gamma = 1/2 in four batches:
    1.2 to 1.5 times as long. Fewer than need be: larger tables, and another loop to
    compile.)
    """
    lanes = workers * LANE_SETTINGS.width
    longest = SETTINGS.longest_job * work.max(initial=1.0)
    most = min(work.size // (2 * lanes), int(work.sum() / (lanes * longest)))
    return max(min(int(np.ceil(work.sum() / SETTINGS.batch)), most), 1)


def _of_jobs(plan: BracketPlan, of_legs: np.ndarray) -> np.ndarray:
    """Sums over the legs of each job, (jobs,)."""
    so_far = np.concatenate([[0.0], np.cumsum(of_legs)])
    return so_far[plan.jobs.past_leg] - so_far[plan.jobs.first_leg]


class Effort(NamedTuple):
    """What lanes have taken so far, shape (cells,).

    `steps`, `rejected`: of all lanes. `waited`: those of `SETTINGS.patience`.
    """

    steps: np.ndarray
    rejected: np.ndarray
    waited: np.ndarray

    def more(self, other: "Effort") -> "Effort":
        """That of both."""
        return Effort(*(a + b for a, b in zip(self, other, strict=True)))


def no_effort(count: int) -> Effort:
    """Of so many cells, before the first lane."""
    return Effort(*np.zeros((3, count)))


class BracketRound(NamedTuple):
    """What one round of windows has found, and what has been taken up to then."""

    plan: BracketPlan
    found: SegmentEnds
    effort: Effort


class BracketContext(NamedTuple):
    """What all rounds of one sweep share.

    `brief` (cells,): tolerances of lanes on fast slides through a few wells; None: those of
    the others. `workers`: queues at once. `effort`: what lanes have taken before.
    `lanes_run` is called as lanes set off.
    """

    scene: Scene
    lanes: LaneScene
    path: Path
    ground: CellBounds
    cells: LaneCells
    tableau: Tableau
    wanted: Sums
    accuracy: float
    report: Report
    effort: Effort
    brief: np.ndarray | None
    workers: int = WORKERS
    lanes_run: Callable[[], None] = lambda: None

    def run(self, windows: Brackets, wells: np.ndarray, back: np.ndarray) -> BracketRound:
        """March all windows, from `wells` of the path or `back` of a fast slide before."""
        starts = starts_of(
            scene=self.scene,
            path=self.path,
            ground=self.ground,
            cell=windows.cell,
            begin=windows.begin,
            wells=wells,
            back=back,
        )
        return self.march_from(windows, starts)

    def march_from(self, windows: Brackets, starts: Starts) -> BracketRound:
        """March all windows from their starts."""
        return self.through(self.planned(windows, starts))

    def planned(self, windows: Brackets, starts: Starts) -> BracketPlan:
        """What lanes are to do for windows, from their starts."""
        return plan_brackets(self.scene, self.path, self.ground, windows, starts)

    def through(self, plan: BracketPlan) -> BracketRound:
        """March all windows of a plan."""
        able, plan = self._within_patience(plan)
        found = self._march(plan, able)
        return BracketRound(plan, found, self.effort.more(self._taken(plan, found)))

    def _taken(self, plan: BracketPlan, found: SegmentEnds) -> Effort:
        """What the lanes of a plan took."""
        owner = np.repeat(plan.jobs.cell, plan.jobs.past_leg - plan.jobs.first_leg)
        count = self.ground.eps.size
        steps, rejected = (
            np.bincount(owner, np.nan_to_num(each), count)
            for each in (found.steps, found.rejected)
        )
        return Effort(steps, rejected, self._waited(plan, found))

    def _within_patience(self, plan: BracketPlan) -> tuple[np.ndarray, BracketPlan]:
        """Which jobs their cells can still wait for, and the plan with what is left."""
        jobs, legs = plan.jobs, plan.legs
        left = np.where(
            self._alone(plan), np.inf, SETTINGS.patience - self.effort.waited[jobs.cell]
        )
        owner = np.repeat(np.arange(left.size), jobs.past_leg - jobs.first_leg)
        wells = np.abs(legs.guide1 - legs.guide0) / self.ground.eps[jobs.cell[owner]]
        allowed = left[owner] + SETTINGS.path_steps * wells
        legs = legs._replace(budget=np.minimum(legs.budget, allowed))
        return left > 0, plan._replace(legs=legs)

    def _waited(self, plan: BracketPlan, found: SegmentEnds) -> np.ndarray:
        """What the longest lane has taken beyond its share, for each cell.

        Of one that gave up everything counts: it would take its share again in each march.
        """
        cell, steps = plan.jobs.cell, _of_jobs(plan, np.nan_to_num(found.steps))
        beyond = np.maximum(steps - SETTINGS.path_steps * self._wells(plan), 0.0)
        gave_up = _of_jobs(plan, np.nan_to_num(found.code)) > 0
        beyond = np.where(gave_up, steps, beyond)
        longest = np.zeros(self.ground.eps.size)
        np.maximum.at(longest, cell, np.where(self._alone(plan), 0.0, beyond))
        return longest

    def _alone(self, plan: BracketPlan) -> np.ndarray:
        """Jobs from a known start, in cells that one lane can go through, (jobs,)."""
        known = np.zeros(plan.jobs.cell.size, dtype=bool)
        known[: plan.known.size] = plan.known
        wells = self.path.travel[-1] / self.ground.eps[plan.jobs.cell]
        return known & (wells <= SETTINGS.affordable)

    def _wells(self, plan: BracketPlan) -> np.ndarray:
        """Wells of the path that jobs go through, (jobs,)."""
        ways = _of_jobs(plan, np.abs(plan.legs.guide1 - plan.legs.guide0))
        return ways / self.ground.eps[plan.jobs.cell]

    def _march(self, plan: BracketPlan, able: np.ndarray) -> SegmentEnds:
        """Deal the jobs that are `able` to the cores, the longest first.

        Others end as lanes do that give up.
        """
        jobs, legs = plan.jobs, plan.legs
        work = self._wells(plan) + 1 + 0.05 * (jobs.past_leg - jobs.first_leg)
        work = np.where(plan.brief, SETTINGS.fast, 1.0) * work
        jobs, cells = self._steered(jobs, plan.brief | plan.calm)
        order = np.argsort(-work, kind="stable")
        order = order[able[order]]
        batches = _batches(work[able], self.workers)
        found = np.full((len(SegmentEnds._fields), legs.start.size), np.nan)
        # Overwritten by lanes that run.
        found[SegmentEnds._fields.index("code")] = int(Status.MAX_STEPS)
        seat = _seats(order.size, batches * self.workers)
        for batch in range(batches):
            queues = [order[seat == batch + i * batches] for i in range(self.workers)]
            for rows, part in self._through(cells, jobs, legs, queues, work):
                found[:, rows] = part
            self.report(1 / batches)
        return SegmentEnds(*found)

    def _steered(self, jobs: Lanes, brief: np.ndarray) -> tuple[Lanes, LaneCells]:
        """Jobs that are `brief` in cells of their own, with their tolerance."""
        if self.brief is None or not brief.any():
            return jobs, self.cells
        loosest = np.maximum(self.brief, self.cells.loosest)
        others = self.cells._replace(tolerance=self.brief, loosest=loosest)
        both = (np.concatenate(pair) for pair in zip(self.cells, others, strict=True))
        return jobs._replace(cell=jobs.cell + brief * self.brief.size), LaneCells(*both)

    def _through(self, cells: LaneCells, jobs: Lanes, legs: Segments, queues: list, work):
        """Legs of each queue and what is found there; the first is run by this thread.

        Beside other cells' lanes two of the pool's would wait for each other.
        """
        parts = [(cells, jobs, legs, queue, work) for queue in queues if queue.size]
        self.lanes_run()
        beside = [crew("lanes").submit(self._queue, *part) for part in parts[1:]]
        found = [self._queue(*part) for part in parts[:1]]
        return found + [part.result() for part in beside]

    def _queue(self, cells, jobs, legs, chosen: np.ndarray, work: np.ndarray) -> tuple:
        """Legs of some jobs, and what is found there."""
        mine = Lanes(*(np.asarray(column)[chosen] for column in jobs))
        # Rows of this queue's legs only, in the order of its jobs.
        count = mine.past_leg - mine.first_leg
        past = np.cumsum(count)
        rows = np.repeat(mine.first_leg - (past - count), count) + np.arange(count.sum())
        mine = mine._replace(first_leg=past - count, past_leg=past)
        some = Segments(*(column[rows] for column in legs))
        fixed = self.tableau, self.wanted
        return rows, march(self.lanes, cells, mine, some, *fixed, work[chosen])


def close_brackets(
    rounds: BracketContext, layout: Layout, needs: Requirements
) -> tuple[BracketValues, np.ndarray]:
    """Rounds of windows, further back each time; and windows that never closed."""
    windows = layout.windows
    size = windows.stop.size
    values = np.full((len(SegmentEnds._fields), size), np.nan)
    legs = np.full((len(Segments._fields), size), np.nan)
    gap, how = np.full(size, np.inf), np.zeros(size, dtype=int)
    open_ = np.arange(windows.cell.size)
    wells = run_ups(rounds, windows, needs.run_up)
    back = np.zeros(wells.size)
    for _ in range(SETTINGS.rounds):
        some = windows.chosen(open_)
        place = np.flatnonzero(np.isin(windows.owner, open_))
        place = place[np.argsort(windows.owner[place], kind="stable")]
        plan, found, effort = rounds.run(some, wells[open_], back[open_])
        rounds = rounds._replace(effort=effort)
        speed = rounds.path.speed
        gaps = gaps_of(found, plan.legs, plan.behind, plan.ahead, speed)
        begins = plan.meet_behind, plan.meet_ahead
        meets = gaps_of(found, plan.legs, *begins, speed)
        # Stops that one lane alone has reached count as closed as their window's begin.
        alone = plan.ahead < 0
        gaps = np.where(alone, meets[some.owner], gaps)
        values[:, place] = np.stack([v[plan.behind] for v in found])
        legs[:, place] = np.stack([v[plan.behind] for v in plan.legs])
        gap[place] = gaps
        how[place] = np.where(plan.known, 0, 1 + plan.from_slide)[some.owner]
        worst = np.zeros(some.cell.size)
        np.maximum.at(worst, some.owner, np.nan_to_num(gaps, nan=np.inf))
        # Lanes that met before a stop part again for a moment where it is at a slip: the
        # start is forgotten all the same, and the gap is reported as it is. Lanes from
        # close by have had steps of their own, which part them further: they go back once,
        # and so do those that set off from a fast slide where their window begins.
        far = (wells[open_] > SETTINGS.margin) & ~(plan.from_slide & (back[open_] < 1))
        met = np.maximum(meets, shifts_of(found, plan.legs, *begins, speed))
        met = np.where(far, np.nan_to_num(met, nan=np.inf), np.inf)
        worst = np.minimum(worst, met)
        open_ = open_[worst > SETTINGS.closed * rounds.accuracy]
        if open_.size == 0:
            break
        wells[open_] = np.maximum(SETTINGS.earlier * wells[open_], SETTINGS.margin + 1)
        back[open_] = SETTINGS.earlier * np.maximum(back[open_], 1)
    result = BracketValues(
        arrivals=SegmentEnds(*values),
        legs=Segments(*legs),
        gap=gap,
        how=how,
        steps=rounds.effort.steps,
        rejected=rounds.effort.rejected,
    )
    return result, open_


def run_ups(rounds: BracketContext, windows: Brackets, needed: np.ndarray) -> np.ndarray:
    """Wells that each window starts earlier: fewer where its slide is slow, (W,).

    Slides remember in proportion to the square of their speed.
    """
    wells = needed[windows.cell].astype(float)
    long = (wells > SETTINGS.long_memory) & np.isfinite(wells)
    if not long.any():
        return wells
    near = np.full(wells.size, SETTINGS.margin + 1.0)
    scene, path = rounds.scene, rounds.path
    starts = starts_of(
        scene=scene,
        path=path,
        ground=rounds.ground,
        cell=windows.cell,
        begin=windows.begin,
        wells=near,
        back=near,
        measured=False,
    )
    states = states_at(scene, path, starts.time)
    share = slow_share(scene, path, starts.time, states)
    share = np.where(starts.from_slide | starts.lagging, 1.0, share)
    # Others keep theirs: what they find must not depend on their neighbours.
    return np.where(
        long, np.ceil(SETTINGS.margin + share * (wells - SETTINGS.margin)), wells
    )
