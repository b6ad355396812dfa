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
)
from .equation import Status
from .lanes import LaneCells, LaneScene, Room, Sums, prepare
from .limit_path import NODES, Path, path_of
from .plan import LOOSEST, TABLEAU, TILES, lane_scene, planned
from .rosenbrock import Tableau
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


def _put(whole: CellResults, part: CellResults, chosen: np.ndarray) -> None:
    """The answers of another attempt; its steps are on top of those before."""
    steps = whole.steps[chosen], whole.rejected[chosen]
    part = part._replace(steps=part.steps + steps[0], rejected=part.rejected + steps[1])
    for name, here in part._asdict().items():
        if name != "tolerance":
            getattr(whole, name)[chosen] = here


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

    def rounds(self, every: _Cellwise) -> BracketContext:
        """What rounds of windows of some cells need."""
        fixed = self.scene, self.lanes, self.path
        parts = *fixed, every.ground, every.cells, self.tableau
        nothing = np.zeros((2, every.eps.size))
        told = self.wanted, self.accuracy, self.report
        waited = np.zeros(every.eps.size)
        return BracketContext(*parts, *told, nothing, waited, every.brief, self.workers)

    def attempt(self, cells: _Cellwise) -> tuple[CellResults, np.ndarray]:
        """Answers of some cells, and which of them have a bracket that stays open."""
        rides, whole = cells.ground.rides, any(self.wanted) or self.every_slip
        cut = self.ts, cells.needs, rides, self.accuracy
        layout = lay_out(self.scene, self.path, cells.eps, *cut, whole)
        rounds = self.rounds(cells)
        found, open_ = close_brackets(rounds, layout, cells.needs)
        start = cells.ground.start_well, cells.ground.start_tip
        summed = layout, found, self.wanted, start, self.accuracy
        answers = evaluate(self.scene, self.path, cells.eps, self.ts, *summed)
        never = np.zeros(cells.eps.size, dtype=bool)
        never[layout.windows.cell[open_]] = True
        return answers, never

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
    answers, never = _first_attempt(sweep, parts, ridden)
    answers = answers._replace(tolerance=np.asarray(control.tolerance))
    for _ in range(_SURVEYS):
        rough = np.flatnonzero(sweep.is_rough(answers, eps) & ~never)
        if not _surveyed_again(sweep, parts, answers, never, rough):
            break
    _in_tiles(sweep, parts, answers, never)
    _from_the_start(sweep, parts, answers, np.flatnonzero(never))
    return answers


def _surveyed_again(sweep: _Sweep, every: _Cellwise, answers, never, rough) -> bool:
    """Twice as many slips of the `rough` cells, at last all; whether there were any."""
    some = _some(every, rough)
    nodes = some.needs.nodes * 2 * (some.needs.nodes < _MOST_NODES)
    can = _affordable(sweep.path, some) | (nodes > 0)
    answers.status[rough[~can]] = int(Status.ROUGH_SURVEY)
    again = rough[can]
    if again.size == 0:
        return False
    wells = sweep.path.travel[-1] / some.eps
    tile = np.where(nodes > 0, some.needs.tile, np.maximum(some.needs.tile, wells / TILES))
    every.needs.nodes[again], every.needs.tile[again] = nodes[can], tile[can]
    part, never[again] = sweep.attempt(_some(every, again))
    _put(answers, part, again)
    return True


def _in_tiles(
    sweep: _Sweep, every: _Cellwise, answers: CellResults, never: np.ndarray
) -> None:
    """Every slip in longer tiles, for cells of which a bracket stays open.

    At gamma = 0.75, eps = 1e-4, accuracy 1e-6: 1.5 s, where one lane takes 30.
    """
    chosen = np.flatnonzero(never)
    chosen = chosen[_affordable(sweep.path, _some(every, chosen))]
    if chosen.size == 0:
        return
    some = _some(every, chosen)
    wells = sweep.path.travel[-1] / some.eps
    tile = np.maximum(4 * some.needs.tile, wells / TILES)
    needs = some.needs._replace(nodes=np.zeros(chosen.size, dtype=int), tile=tile)
    part, open_ = sweep.attempt(some._replace(needs=needs))
    _put(answers, part, chosen)
    never[chosen] = open_


def _first_attempt(
    sweep: _Sweep, every: _Cellwise, ridden: np.ndarray
) -> tuple[CellResults, np.ndarray]:
    """Answers of all cells, and which have an open bracket: those without rides aside.

    Their lanes run while rides are found, which is mostly NumPy on one core.
    """
    some, others = np.flatnonzero(ridden), np.flatnonzero(~ridden)
    if some.size == 0:
        return sweep.attempt(every)
    if others.size == 0:
        return _with_rides(sweep, every, some)
    # Beside the first lanes that look for rides: with both planning at once, and two lanes
    # waiting for one core, a sweep took a tenth longer.
    lanes_run = threading.Event()

    def aside() -> tuple[CellResults, np.ndarray]:
        lanes_run.wait()
        # With both cores lanes would hold up every small program of the other thread.
        return sweep._replace(workers=1).attempt(_some(every, others))

    beside = crew("cells", 1).submit(aside)
    try:
        found, open_ = _with_rides(sweep, every, some, lanes_run.set)
    finally:
        lanes_run.set()
        rest = beside.result()
    parts = ((others, *rest), (some, found, open_))
    never = np.zeros(ridden.size, dtype=bool)
    columns = []
    for pair in zip(*(answers for _, answers, _ in parts), strict=True):
        whole = np.empty((ridden.size, *pair[0].shape[1:]), pair[0].dtype)
        whole[others], whole[some] = pair
        columns.append(whole)
    for which, _, open_ in parts:
        never[which] = open_
    return CellResults(*columns), never


def _with_rides(
    sweep: _Sweep,
    every: _Cellwise,
    chosen: np.ndarray,
    lanes_run: Callable[[], None] = lambda: None,
) -> tuple[CellResults, np.ndarray]:
    """An attempt at some cells after their rides have been found."""
    some = _some(every, chosen)
    rounds = sweep.rounds(some)._replace(lanes_run=lanes_run)
    measured = find_fast_slides(rounds, some.needs)
    # The rides belong to the cells from here on: later attempts use them too.
    every.ground.rides[chosen] = some.ground.rides
    has = np.array([len(rides) > 0 for rides in some.ground.rides])
    nodes = np.where(has, NODES, some.needs.nodes)
    every.needs.nodes[chosen] = nodes
    answers, never = sweep.attempt(some._replace(needs=some.needs._replace(nodes=nodes)))
    measured()
    spent = answers.steps + rounds.spent[0], answers.rejected + rounds.spent[1]
    return answers._replace(steps=spent[0], rejected=spent[1]), never


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


def _from_the_start(
    sweep: _Sweep, every: _Cellwise, answers: CellResults, open_: np.ndarray
) -> None:
    """One lane from z0 through everything, for cells whose brackets stay open."""
    if open_.size == 0:
        return
    can = _affordable(sweep.path, _some(every, open_))
    answers.status[open_[~can]] = int(Status.OPEN_BRACKET)
    for values in (answers.z, answers.dissipation):
        values[open_[~can]] = np.nan
    chosen = open_[can]
    if chosen.size == 0:
        return
    some = _some(every, chosen)
    # From a ride it would set off as far from the tip as the brackets that stayed open.
    some.ground.rides.fill(())
    forever, none = np.full(chosen.size, np.inf), np.zeros(chosen.size)
    uncut = np.zeros_like(some.needs.cut)
    needs = some.needs._replace(
        warm=forever, settle=none, tile=forever, nodes=none, cut=uncut
    )
    part, open_ = sweep.attempt(some._replace(needs=needs))
    _put(answers, part, chosen)
    left = chosen[open_]  # lanes that failed say why
    good = answers.status[left] == int(Status.OK)
    answers.status[left[good]] = int(Status.OPEN_BRACKET)
