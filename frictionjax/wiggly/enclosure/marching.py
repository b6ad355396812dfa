"""Brackets through the lanes, dealt to the cores: what lanes find, and what they took."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..._compile import cores, crew
from ...model import TabulatedScene
from ...numerics import concatenated, rows_of
from ..equation import Status
from ..lanes import SETTINGS as LANE_SETTINGS
from ..lanes import LaneCells, Lanes, LaneScene, SegmentEnds, Segments, march
from ..limit_path import Path
from ..rosenbrock import Tableau
from .brackets import BracketPlan, Brackets, plan_brackets
from .settings import SETTINGS
from .starts import CellBounds, Starts, starts_of

Report = Callable[[float], None]


def _seats(count: int, seats: int) -> np.ndarray:
    """Seats dealt there and back, so that none gets all the lanes behind of brackets."""
    row, seat = np.divmod(np.arange(count), seats)
    return np.where(row % 2 == 0, seat, seats - 1 - seat)


def _blocks(work: np.ndarray, legs: np.ndarray, workers: int) -> list[np.ndarray]:
    """Which jobs go together, in blocks, those that take longest first.

    As often as a report is wanted, and no more than the smallest loop has room for, so that
    no larger one is compiled (2.5 s of a study), unless lanes idled: a block has more to do
    than its longest job takes. (Where each has some of the longest, all of them wait.)
    """
    order = np.argsort(-work, kind="stable")
    done, took = np.cumsum(work[order]), np.cumsum(legs[order])
    lanes = workers * LANE_SETTINGS.width
    _, jobs, room = (int(SETTINGS.filled * workers * n) for n in LANE_SETTINGS.room)
    blocks, start = [], 0
    while start < order.size:
        before, used = (total[start - 1] if start else 0.0 for total in (done, took))
        least, short = lanes * work[order[start]] * np.array(SETTINGS.longest_job)
        wanted = np.searchsorted(done, before + max(short, SETTINGS.batch)) + 1
        if wanted < order.size and done[-1] - done[wanted - 1] < short:
            wanted = order.size  # what is left would be no block
        fits = min(np.searchsorted(took, used + room, side="right"), start + jobs)
        # Where half a block does not fit, a larger loop is needed, and holds a whole one.
        half = np.searchsorted(done, before + least) + 1
        end = wanted if half > fits else min(wanted, fits)
        blocks.append(order[start:end])
        start = end
    return blocks


def _of_jobs(plan: BracketPlan, of_segments: np.ndarray) -> np.ndarray:
    """Sums over the segments of each job, (jobs,)."""
    so_far = np.concatenate([[0.0], np.cumsum(of_segments)])
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
        return Effort._make(a + b for a, b in zip(self, other, strict=True))


def no_effort(count: int) -> Effort:
    """Of so many cells, before the first lane."""
    return Effort._make(np.zeros((3, count)))


class BracketRound(NamedTuple):
    """What one round of brackets has found, and what has been taken up to then."""

    plan: BracketPlan
    ends: SegmentEnds
    effort: Effort


class BracketContext(NamedTuple):
    """What all rounds of one sweep share.

    `brief` (cells,): tolerances of lanes on fast slides through a few wells; None: those of
    the others. `effort`: what lanes have taken before. `looking`: whether lanes are for
    looks, of which all steps are waited for.
    """

    scene: TabulatedScene
    lanes: LaneScene
    path: Path
    ground: CellBounds
    cells: LaneCells
    tableau: Tableau
    summed: bool
    accuracy: float
    report: Report
    effort: Effort
    brief: np.ndarray | None
    looking: bool = False

    def run(self, brackets: Brackets, wells: np.ndarray, back: np.ndarray) -> BracketRound:
        """March all brackets, from `wells` of the path or `back` of a fast slide before."""
        starts = starts_of(
            path=self.path,
            ground=self.ground,
            cell=brackets.cell,
            begin=brackets.begin,
            wells=wells,
            back=back,
        )
        return self.march_from(brackets, starts)

    def march_from(self, brackets: Brackets, starts: Starts) -> BracketRound:
        """March all brackets from their starts."""
        return self.through(self.planned(brackets, starts))

    def planned(self, brackets: Brackets, starts: Starts) -> BracketPlan:
        """What lanes are to do for brackets, from their starts."""
        return plan_brackets(self.path, self.ground, brackets, starts)

    def through(self, plan: BracketPlan) -> BracketRound:
        """March all brackets of a plan."""
        able, plan = self._within_patience(plan)
        ends = self._march(plan, able)
        return BracketRound(plan, ends, self.effort.more(self._taken(plan, ends)))

    def _taken(self, plan: BracketPlan, ends: SegmentEnds) -> Effort:
        """What the lanes of a plan took."""
        cell, count = plan.jobs.cell[plan.owner], self.ground.eps.size
        steps, rejected = (
            np.bincount(cell, np.nan_to_num(each), count)
            for each in (ends.steps, ends.rejected)
        )
        return Effort(steps, rejected, self._waited(plan, ends))

    @property
    def _forgets(self) -> np.ndarray:
        """1 of usual cells, (cells,); less, down to 0, of those that remember so much that
        brackets go through all of it, in vain."""
        memory = self.ground.longest_memory / SETTINGS.longest_memory
        return np.clip(2 - memory, 0.0, 1.0)

    @property
    def _share(self) -> np.ndarray:
        """Steps for a well of the path that cells are not said to wait for, (cells,)."""
        return SETTINGS.path_steps * (not self.looking) * self._forgets

    def _within_patience(self, plan: BracketPlan) -> tuple[np.ndarray, BracketPlan]:
        """Which jobs their cells can still wait for, and the plan with what is left."""
        jobs, segments = plan.jobs, plan.segments
        left = SETTINGS.patience - self.effort.waited[jobs.cell]
        left[self._alone(plan)] = np.inf
        left[self._known(plan) & self.ground.is_far(self.path)[jobs.cell]] = 0.0
        owner = plan.owner
        cell = jobs.cell[owner]
        wells = np.abs(segments.guide1 - segments.guide0) / self.ground.eps[cell]
        allowed = left[owner] + self._share[cell] * wells
        segments = segments._replace(budget=np.minimum(segments.budget, allowed))
        # In all on the way no more than that, where little is forgotten.
        many = SETTINGS.lane_steps * self._forgets[jobs.cell] * self._wells(plan)
        jobs = jobs._replace(patience=np.where(self.looking, np.inf, left + many))
        return left > 0, plan._replace(jobs=jobs, segments=segments)

    def _waited(self, plan: BracketPlan, ends: SegmentEnds) -> np.ndarray:
        """What the longest lane has taken beyond its share, for each cell.

        Of one that gave up everything counts: it would take its share again in each march.
        """
        cell, steps = plan.jobs.cell, _of_jobs(plan, np.nan_to_num(ends.steps))
        beyond = np.maximum(steps - self._share[cell] * self._wells(plan), 0.0)
        gave_up = _of_jobs(plan, np.nan_to_num(ends.code)) > 0
        beyond = np.where(gave_up, steps, beyond)
        longest = np.zeros(self.ground.eps.size)
        np.maximum.at(longest, cell, np.where(self._alone(plan), 0.0, beyond))
        return longest

    def _alone(self, plan: BracketPlan) -> np.ndarray:
        """Jobs from a known start, in cells that one lane can go through, (jobs,)."""
        return self._known(plan) & self.ground.is_affordable(self.path)[plan.jobs.cell]

    def _known(self, plan: BracketPlan) -> np.ndarray:
        """Jobs from a known start, (jobs,)."""
        known = np.zeros(plan.jobs.cell.size, dtype=bool)
        known[: plan.known_start.size] = plan.known_start
        return known

    def _wells(self, plan: BracketPlan) -> np.ndarray:
        """Wells of the path that jobs go through, (jobs,)."""
        ways = _of_jobs(plan, np.abs(plan.segments.guide1 - plan.segments.guide0))
        return ways / self.ground.eps[plan.jobs.cell]

    def _march(self, plan: BracketPlan, able: np.ndarray) -> SegmentEnds:
        """Deal the jobs that are `able` to the cores, the longest first.

        Others end as lanes do that give up.
        """
        jobs, segments = plan.jobs, plan.segments
        work = self._wells(plan) + 1 + 0.05 * jobs.legs
        work = np.where(plan.brief, SETTINGS.fast, 1.0) * work
        jobs, cells = self._steered(plan)
        some = np.flatnonzero(able)
        # Where a narrow loop ends little later than its longest lane, one thread is enough.
        soon = work[some].max(initial=0.0) + LANE_SETTINGS.handed_over
        workers = 1 if work[some].sum() <= LANE_SETTINGS.narrow * soon else cores()
        ends = np.full((len(SegmentEnds._fields), segments.start.size), np.nan)
        # Overwritten by lanes that run.
        ends[SegmentEnds._fields.index("code")] = int(Status.MAX_STEPS)
        total = work[some].sum()
        for block in _blocks(work[some], jobs.legs[some], workers):
            seat = _seats(block.size, workers)
            queues = [some[block[seat == i]] for i in range(workers)]
            for rows, part in self._through(cells, jobs, segments, queues, work):
                ends[:, rows] = part
            self.report(work[some[block]].sum() / total)
        return SegmentEnds._make(ends)

    def _steered(self, plan: BracketPlan) -> tuple[Lanes, LaneCells]:
        """Jobs with tolerances of their own, in cells of their own."""
        jobs, cells, brief = plan.jobs, self.cells, plan.brief | plan.forgetful
        if self.brief is not None and brief.any():
            loosest = np.maximum(self.brief, cells.loosest)
            others = cells._replace(tolerance=self.brief, loosest=loosest)
            jobs = jobs._replace(cell=jobs.cell + brief * self.brief.size)
            cells = concatenated([cells, others])
        most = self._at_turns(plan)
        finer = most < cells.tolerance[jobs.cell]
        if not finer.any():
            return jobs, cells
        kinds = np.stack([jobs.cell[finer], most[finer]])
        (like, tolerance), which = np.unique(kinds, axis=1, return_inverse=True)
        own = rows_of(cells, like.astype(int))._replace(tolerance=tolerance)
        moved = jobs.cell.copy()
        moved[finer] = cells.eps.size + which.ravel()
        return jobs._replace(cell=moved), concatenated([cells, own])

    def _at_turns(self, plan: BracketPlan) -> np.ndarray:
        """What steps of jobs may err by where the load turns on their way, (jobs,)."""
        found = np.full(plan.jobs.cell.size, np.inf)
        kinks, allowed = self.path.edges[1:-1], self.ground.at_turns
        if not np.isfinite(allowed).any():
            return found
        place = np.minimum(np.searchsorted(kinks, plan.segments.end), kinks.size - 1)
        there = kinks[place] == plan.segments.end
        owner, place = plan.owner[there], place[there]
        np.minimum.at(found, owner, allowed[plan.jobs.cell[owner], place])
        return found

    def _through(
        self, cells: LaneCells, jobs: Lanes, segments: Segments, queues: list, work
    ):
        """Segments of each queue and what is found there; this thread runs the first."""

        def run(chosen: np.ndarray) -> tuple[np.ndarray, SegmentEnds]:
            return self._queue(cells, jobs, segments, chosen, work)

        own, *others = [queue for queue in queues if queue.size]
        beside = [crew("lanes").submit(run, queue) for queue in others]
        return [run(own), *(part.result() for part in beside)]

    def _queue(self, cells, jobs, segments, chosen: np.ndarray, work: np.ndarray) -> tuple:
        """Segments of chosen jobs, and what is found there."""
        mine = rows_of(jobs, chosen)
        # Rows of this queue's segments only, in the order of its jobs.
        count = mine.legs
        past = np.cumsum(count)
        rows = np.repeat(mine.first_leg - (past - count), count) + np.arange(count.sum())
        mine = mine._replace(first_leg=past - count, past_leg=past)
        chosen_segments = rows_of(segments, rows)
        return rows, march(
            self.lanes,
            cells,
            mine,
            chosen_segments,
            self.tableau,
            self.summed,
            work[chosen],
        )
