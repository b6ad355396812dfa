"""All cells of a sweep through lanes: rounds of windows until every bracket has closed."""

import threading
from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import numpy as np

from .._checks import quiet_where_extreme, viscosity_of
from .._compile import WORKERS, crew
from ..model import Scene
from .enclosure import (
    AFFORDABLE,
    CLOSED,
    BracketContext,
    CellBounds,
    Report,
    Requirements,
    close_brackets,
    find_fast_slides,
    lay_out,
    no_effort,
)
from .equation import Status
from .lanes import LaneCells, LaneScene, Room, Sums, prepare
from .limit_path import NODES, Path, path_of
from .plan import LOOSEST, TABLEAU, TILES, lane_scene, planned
from .rosenbrock import Tableau
from .slip_map import none_known
from .sums import CellResults, evaluate

_MOST_NODES, _SURVEYS = 65, 3
_FEW = 500  # values that are worth a guess at rooms


class _Cellwise(NamedTuple):
    """What an attempt needs of each cell."""

    eps: np.ndarray
    ground: CellBounds
    cells: LaneCells
    brief: np.ndarray
    needs: Requirements


def _some(parts: Any, chosen: np.ndarray) -> Any:
    return jax.tree_util.tree_map(lambda v: np.asarray(v)[chosen], parts)


def _with_rows(column: np.ndarray, chosen: np.ndarray, rows: Any) -> np.ndarray:
    """The column with other values in the rows `chosen`."""
    changed = column.copy()
    changed[chosen] = rows
    return changed


class _SoFar(NamedTuple):
    """Cells with all that is known of them, their answers, and which brackets stay open.

    `open_` (cells,): whether a bracket of the cell does.
    """

    cells: _Cellwise
    answers: CellResults
    open_: np.ndarray

    def with_status(self, chosen: np.ndarray, status: Status) -> "_SoFar":
        """Some cells with another status."""
        changed = _with_rows(self.answers.status, chosen, int(status))
        return self._replace(answers=self.answers._replace(status=changed))

    def with_attempt(self, part: "_SoFar", chosen: np.ndarray) -> "_SoFar":
        """The answers of another attempt; its steps are on top of those before."""
        whole, new = self.answers, part.answers
        columns = {
            name: _with_rows(column, chosen, getattr(new, name))
            for name, column in whole._asdict().items()
        }
        columns |= {
            "steps": _with_rows(whole.steps, chosen, new.steps + whole.steps[chosen]),
            "rejected": _with_rows(
                whole.rejected, chosen, new.rejected + whole.rejected[chosen]
            ),
            "tolerance": whole.tolerance,
        }
        open_ = _with_rows(self.open_, chosen, part.open_)
        return self._replace(answers=CellResults(**columns), open_=open_)

    def with_needs(self, needs: Requirements, chosen: np.ndarray) -> "_SoFar":
        """Other needs of some cells, for later attempts too."""
        rows = zip(self.cells.needs, needs, strict=True)
        changed = Requirements(*(_with_rows(old, chosen, new) for old, new in rows))
        return self._replace(cells=self.cells._replace(needs=changed))


class _Sweep(NamedTuple):
    """What all attempts share."""

    scene: Scene
    path: Path
    lanes: LaneScene
    tableau: Tableau
    ts: np.ndarray
    accuracy: float
    wanted: Sums
    every_slip: bool
    report: Report
    workers: int = WORKERS

    def rounds(self, some: _Cellwise) -> BracketContext:
        """What rounds of windows of some cells need."""
        return BracketContext(
            scene=self.scene,
            lanes=self.lanes,
            path=self.path,
            ground=some.ground,
            cells=some.cells,
            tableau=self.tableau,
            wanted=self.wanted,
            accuracy=self.accuracy,
            report=self.report,
            effort=no_effort(some.eps.size),
            brief=some.brief,
            workers=self.workers,
        )

    def attempt(self, some: _Cellwise) -> _SoFar:
        """Answers of some cells, and which of them have a bracket that stays open."""
        layout = lay_out(
            scene=self.scene,
            path=self.path,
            eps=some.eps,
            ts=self.ts,
            needs=some.needs,
            fast_slides=some.ground.fast_slides,
            accuracy=self.accuracy,
            summed=any(self.wanted) or self.every_slip,
        )
        found, left = close_brackets(self.rounds(some), layout, some.needs)
        answers = evaluate(
            scene=self.scene,
            path=self.path,
            eps=some.eps,
            ts=self.ts,
            layout=layout,
            found=found,
            wanted=self.wanted,
            start=(some.ground.start_well, some.ground.start_tip),
            accuracy=self.accuracy,
        )
        open_ = np.isin(np.arange(some.eps.size), layout.windows.cell[left])
        return _SoFar(some, answers, open_)

    def is_rough(self, answers: CellResults, eps: np.ndarray) -> np.ndarray:
        """Cells whose surveys are not good to the accuracy, or not known to be."""
        errors = [answers.survey_error / eps]
        if self.wanted.energies:
            errors.append(answers.survey_work_error)
        worst = np.max(errors, axis=0) / (CLOSED * self.accuracy)
        return (worst > 1) | (np.isnan(worst) & (answers.status == int(Status.OK)))


@quiet_where_extreme
def integrate_cells(
    scene: Scene,
    eps: np.ndarray,
    gamma: np.ndarray,
    ts: np.ndarray,
    accuracy: float,
    method: str,
    balanced: bool = True,
    report: Report = lambda share: None,
    suprema: bool = True,
    tableau: Tableau = TABLEAU,
) -> CellResults | None:
    """Every cell (eps, gamma), shape (cells,): values at `ts` and sums over [0, T].

    "resolved" measures every slip, in tiles; "windowed" a few periods of every slide that
    is long enough; "auto" what passes through fewer wells. Surveys that are too rough are
    made again with more periods; where brackets stay open, tiles measure every slip; and
    where theirs do too, one lane goes through all. Accuracies looser than 1e-3 are solved
    as that. Where neither energies are `balanced` nor `suprema` wanted, "windowed" and
    "auto" leave out all slips between the times.
    `report` is told the share of each batch of jobs that is done. `tableau`: another scheme
    than the lanes' own, to compare with. None where the load turns more often than the
    scene has room for.
    """
    path = path_of(scene)
    if path is None:
        return None
    accuracy = min(accuracy, LOOSEST)
    lanes = lane_scene(scene, float(eps.max()))
    wanted = _sums(balanced, suprema)
    _prepare(lanes, eps.size, ts.size, wanted, tableau)
    plan = planned(scene, lanes, path, eps, gamma, ts.size, accuracy, method)
    control, ground, needs, ridden = plan
    steering = control.tolerance, control.loosest, control.pace, control.reach
    cells = LaneCells(eps, viscosity_of(eps, gamma), control.first_step, *steering)
    parts = _Cellwise(eps, ground, cells, np.asarray(control.brief), needs)
    every = method == "resolved"
    sweep = _Sweep(scene, path, lanes, tableau, ts, accuracy, wanted, every, report)
    so_far = _first_attempt(sweep, parts, ridden)
    answers = so_far.answers._replace(tolerance=np.asarray(control.tolerance))
    so_far = so_far._replace(answers=answers)
    for _ in range(_SURVEYS):
        rough = np.flatnonzero(sweep.is_rough(so_far.answers, eps) & ~so_far.open_)
        if rough.size == 0:
            break
        so_far = _surveyed_again(sweep, so_far, rough)
    so_far = _in_tiles(sweep, so_far)
    return _from_the_start(sweep, so_far).answers


def _surveyed_again(sweep: _Sweep, so_far: _SoFar, rough: np.ndarray) -> _SoFar:
    """Twice as many slips of the `rough` cells, at last all."""
    some = _some(so_far.cells, rough)
    nodes = some.needs.nodes * 2 * (some.needs.nodes < _MOST_NODES)
    can = _affordable(sweep.path, some) | (nodes > 0)
    so_far = so_far.with_status(rough[~can], Status.ROUGH_SURVEY)
    again = rough[can]
    if again.size == 0:
        return so_far
    wells = sweep.path.travel[-1] / some.eps
    tile = np.where(nodes > 0, some.needs.tile, np.maximum(some.needs.tile, wells / TILES))
    needs = _some(some.needs._replace(nodes=nodes, tile=tile), can)
    so_far = so_far.with_needs(needs, again)
    return so_far.with_attempt(sweep.attempt(_some(so_far.cells, again)), again)


def _in_tiles(sweep: _Sweep, so_far: _SoFar) -> _SoFar:
    """Every slip in longer tiles, for cells of which a bracket stays open.

    At gamma = 0.75, eps = 1e-4, accuracy 1e-6: 1.5 s, where one lane takes 30.
    """
    chosen = np.flatnonzero(so_far.open_ & _affordable(sweep.path, so_far.cells))
    if chosen.size == 0:
        return so_far
    some = _some(so_far.cells, chosen)
    wells = sweep.path.travel[-1] / some.eps
    tile = np.maximum(4 * some.needs.tile, wells / TILES)
    needs = some.needs._replace(nodes=np.zeros(chosen.size, dtype=int), tile=tile)
    return so_far.with_attempt(sweep.attempt(some._replace(needs=needs)), chosen)


def _first_attempt(sweep: _Sweep, every: _Cellwise, ridden: np.ndarray) -> _SoFar:
    """Answers of all cells: those without slip maps aside.

    Their lanes run while fast slides are found, which is mostly NumPy on one core.
    """
    some, others = np.flatnonzero(ridden), np.flatnonzero(~ridden)
    if some.size == 0:
        return sweep.attempt(every)
    if others.size == 0:
        return _by_slip_maps(sweep, every)
    # Beside the first lanes that look for slides: with both planning at once, and two lanes
    # waiting for one core, a sweep took a tenth longer.
    lanes_run = threading.Event()

    def aside() -> _SoFar:
        lanes_run.wait()
        # With both cores lanes would hold up every small program of the other thread.
        return sweep._replace(workers=1).attempt(_some(every, others))

    beside = crew("cells", 1).submit(aside)
    try:
        found = _by_slip_maps(sweep, _some(every, some), lanes_run.set)
    finally:
        lanes_run.set()
        rest = beside.result()
    return _merged(every, (others, rest), (some, found))


def _merged(every: _Cellwise, *parts: tuple[np.ndarray, _SoFar]) -> _SoFar:
    """All cells from attempts at some of them each, in their order."""
    order = np.argsort(np.concatenate([which for which, _ in parts]))
    columns = zip(*(part.answers for _, part in parts), strict=True)
    answers = CellResults(*(np.concatenate(column)[order] for column in columns))
    open_ = np.concatenate([part.open_ for _, part in parts])[order]
    slides = np.concatenate([part.cells.ground.fast_slides for _, part in parts])[order]
    needs = zip(*(part.cells.needs for _, part in parts), strict=True)
    cells = every._replace(
        ground=every.ground._replace(fast_slides=slides),
        needs=Requirements(*(np.concatenate(column)[order] for column in needs)),
    )
    return _SoFar(cells, answers, open_)


def _by_slip_maps(
    sweep: _Sweep, some: _Cellwise, lanes_run: Callable[[], None] = lambda: None
) -> _SoFar:
    """An attempt at cells whose fast slides are found first, and stay known."""
    rounds = sweep.rounds(some)._replace(lanes_run=lanes_run)
    found = find_fast_slides(rounds, some.needs)
    has = np.array([len(own) > 0 for own in found.slides])
    some = some._replace(
        ground=some.ground._replace(fast_slides=found.slides),
        needs=some.needs._replace(nodes=np.where(has, NODES, some.needs.nodes)),
    )
    so_far = sweep.attempt(some)
    steps, rejected, _ = found.effort()
    answers = so_far.answers._replace(
        steps=so_far.answers.steps + steps, rejected=so_far.answers.rejected + rejected
    )
    return so_far._replace(answers=answers)


def prepare_cells(
    scene: Scene, eps: np.ndarray, times: int, balanced: bool = True, suprema: bool = True
) -> None:
    """Have the loop for cells of these eps compiled, before `integrate_cells` asks."""
    lanes = lane_scene(scene, float(eps.max()))
    _prepare(lanes, eps.size, times, _sums(balanced, suprema))


def _sums(balanced: bool, suprema: bool) -> Sums:
    return Sums(energies=balanced, extremes=balanced or suprema)


def _prepare(
    lanes: LaneScene, cells: int, times: int, wanted: Sums, tableau: Tableau = TABLEAU
) -> None:
    """Have the loop compiled beside the planning."""
    if cells * times > _FEW:
        legs = cells * times // WORKERS
        prepare(lanes, tableau, Room(cells, legs // 2, legs), wanted)


def _affordable(path: Path, cells: _Cellwise) -> np.ndarray:
    return path.travel[-1] / cells.eps <= AFFORDABLE


def _from_the_start(sweep: _Sweep, so_far: _SoFar) -> _SoFar:
    """One lane from z0 through everything, for cells whose brackets stay open."""
    can = _affordable(sweep.path, so_far.cells)
    chosen, never = np.flatnonzero(so_far.open_ & can), so_far.open_ & ~can
    answers = so_far.answers._replace(
        z=np.where(never[:, None], np.nan, so_far.answers.z),
        dissipation=np.where(never[:, None], np.nan, so_far.answers.dissipation),
    )
    so_far = so_far._replace(answers=answers)
    so_far = so_far.with_status(np.flatnonzero(never), Status.OPEN_BRACKET)
    if chosen.size == 0:
        return so_far
    # From a fast slide it would set off as far from the tip as the brackets that stayed
    # open.
    some = _without_slides(_some(so_far.cells, chosen))
    forever, none = np.full(chosen.size, np.inf), np.zeros(chosen.size)
    needs = some.needs._replace(
        warm=forever, settle=none, tile=forever, nodes=none, cut=some.needs.cut & False
    )
    part = sweep.attempt(some._replace(needs=needs))
    # Lanes that failed say why.
    left = np.flatnonzero(part.open_ & (part.answers.status == int(Status.OK)))
    return so_far.with_attempt(part.with_status(left, Status.OPEN_BRACKET), chosen)


def _without_slides(some: _Cellwise) -> _Cellwise:
    ground = some.ground._replace(fast_slides=none_known(some.eps.size))
    return some._replace(ground=ground)
