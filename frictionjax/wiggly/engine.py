"""All cells of a sweep through lanes: rounds of windows until every bracket has closed."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Array

from ..arguments import Real
from ..coefficients import Coefficients, coefficients_jit
from ..potentials import AbstractPotential, BristlePotential
from ..profiles import AbstractProfile
from ..programs import Program, room
from ..scene import Scene
from .evaluation import Answers, evaluate
from .forgetting import lag_forces
from .lane import Cells, LaneScene, Sums
from .lanes import Room, prepare
from .layout import Needs, cost_of, lay_out, wells_of
from .path import Path, path_of
from .riding import find_rides
from .rodas5p import Rodas5P
from .rosenbrock import Tableau
from .rounds import CLOSED, LONG_MEMORY, MARGIN, WORKERS, Report, Rounds, collect
from .series_bristle import series_of
from .status import Status
from .tolerance import Folds, plan_steps, pull_of
from .tolerance import Plan as StepPlan
from .windows import Ground

# Tiles of a cell, two lanes each: both queues full, twice. (Full once: 0.6 times as fast
# for one cell, as lanes wait for the longest tile; three times: 0.7.) Of the whole sweep
# (256) tiles were longer, a few percent of the steps fewer, and values depended on the
# other cells, by up to a tenth of the accuracy.
_TILES = 128
_NODES, _MOST_NODES, _SURVEYS = 17, 65, 3
# Wells that one lane alone goes through at most: a minute or two.
_AFFORDABLE = 2e5
# Of order 5: the cheaper one at tolerances below 3e-5, as all are at `LOOSEST`.
TABLEAU = Rodas5P.tableau
_NEAR_STRIP = 1e-3  # wells
# Looser brackets and surveys save a fifth of the time, and at gamma = 0.75 were off by up
# to 6 times an accuracy of 1e-1, and twice one of 1e-2.
LOOSEST = 1e-3
_CELLS = 16  # at least, in a compiled call: 64 take 4 ms, 16 one
_FEW = 500  # values that are worth a guess at rooms
# Wells after a slip at which lanes may set off, and the shortest rest that is worth it.
_AFTER_SLIP, _SHORT_REST = 0.05, 0.2
# Lanes set off in the middle of a slip or two, and forget less in their first wells. (1:
# brackets of gamma = 1, eps = 1e-2 stay open; a second round takes as long as the first.)
_SLIPS_FORGET = 1.5
# Wells of a slide that are worth a slip map, where windows set off far back.
_LONG_SLIDE = 300.0


@Program
def _plans(scene, rho_plus, rho_minus, eps, gamma, accuracy) -> StepPlan:
    pull = pull_of(scene, Coefficients(rho_plus, rho_minus))
    return jax.vmap(lambda e, g: plan_steps(scene, e, g, accuracy, pull))(eps, gamma)


def _controls(scene, eps, gamma, accuracy, rho: tuple | None = None) -> StepPlan:
    """Step control of all cells. `rho`: plus and minus, N, where they are known."""
    if rho is None:
        found = coefficients_jit(scene.potential)
        rho = found.rho_plus, found.rho_minus
    return _plans(scene, *map(np.asarray, rho), eps, gamma, np.asarray(accuracy))


def _fixed(values: np.ndarray) -> np.ndarray:
    """Values of the cells padded to few different sizes."""
    return np.pad(values, (0, room(values.size, _CELLS) - values.size), mode="edge")


@Program
def _tips(potential: AbstractPotential, z0: Real, eps: Array):
    return jax.vmap(lambda e: potential.tip(z0, e))(eps)


def ground_of(
    scene: Scene, path: Path, eps: np.ndarray, gamma: np.ndarray, folds: Folds
) -> Ground:
    """What windows need to know of each cell."""
    lags = lag_forces(scene.potential, eps, folds, path.speed * eps**gamma)
    forces = (folds.force_plus, path.rho_plus), (folds.force_minus, path.rho_minus)
    well, tip = _tips(scene.potential, scene.z0, _fixed(eps))
    shifts = [np.abs(force - rho) / path.stiffness for force, rho in forces]
    return Ground(
        eps,
        folds,
        lag_plus=lags[0] / path.stiffness,
        lag_minus=lags[1] / path.stiffness,
        shift_plus=shifts[0],
        shift_minus=shifts[1],
        start_well=np.asarray(well)[: eps.size],
        start_tip=np.asarray(tip)[: eps.size],
        relaxed=_relaxation(scene, path, eps, gamma),
        rides=_no_rides(eps.size),
    )


def _relaxation(scene: Scene, path: Path, eps: np.ndarray, gamma: np.ndarray):
    """Time in s until z0 is within a thousandth of a well of the strip (Lemma 7)."""
    far = abs(float(scene.z0) - path.states[0])
    efolds = np.log(np.maximum(far / (_NEAR_STRIP * eps), 1.0))
    return efolds * eps**gamma / path.stiffness


def _no_rides(count: int) -> np.ndarray:
    rides = np.empty(count, dtype=object)
    rides[:] = [()] * count
    return rides


@Program
def _heights(profile: AbstractProfile, places: Array) -> Array:
    return jax.vmap(profile)(places)


def lane_scene(scene: Scene, highest: float) -> LaneScene:
    """The scene as lanes see it, with the bristle as a series where one converges."""
    potential = scene.potential
    if isinstance(potential, BristlePotential):
        scan = np.arange(potential.points) / potential.points
        height = float(np.max(np.abs(_heights(potential.profile, scan))))
        bristle = series_of(potential.bristle, 1.01 * highest * height)
        potential = BristlePotential(potential.profile, bristle)
    return LaneScene(potential, scene.support, scene.load)


def _needs(control: StepPlan, ground: Ground, path: Path, accuracy: float) -> Needs:
    """How far back windows start: until a bracket as wide as the lag has closed."""
    lag = np.maximum(ground.lag_plus, ground.lag_minus) / ground.eps
    memory = np.asarray(control.memory)[: lag.size]
    forgets = memory * np.log((lag + 2) / (0.1 * accuracy))
    slow = np.ceil(MARGIN + forgets)
    warm = np.minimum(slow, _resting(ground, lag, forgets))
    settle = np.ceil(lag + warm + 2)
    return Needs(warm, settle, 3 * slow, np.zeros(lag.size), _offsets(ground, path))


def _resting(ground: Ground, lag: np.ndarray, forgets: np.ndarray) -> np.ndarray:
    """Wells back to a start between slips, from which a bracket closes at rest.

    Windows begin half a period behind slips. Where tips lag by less than that, both lanes
    of a bracket that sets off a little after a slip come to rest in one well; `forgets`
    wells more pass where the rest of half a period is too short. Infinite where tips lag
    further: their lanes have to catch up with each other.
    """
    shift = np.maximum(ground.shift_plus, ground.shift_minus) / ground.eps
    rest = 0.5 - _AFTER_SLIP - lag - shift
    wells = rest + np.ceil(np.maximum(_SLIPS_FORGET * forgets - rest, 0.0))
    return np.where(rest > _SHORT_REST, wells, np.inf)


def _offsets(ground: Ground, path: Path) -> np.ndarray:
    """From each slide's start to half a period behind a fold, in wells, (cells, pieces)."""
    folds, up = ground.folds, path.direction > 0
    fold = np.where(up, folds.state_plus[:, None], folds.state_minus[:, None])
    past = path.direction * (path.states[:-1] - fold) / ground.eps[:, None]
    return np.mod(0.5 - past, 1.0)


def _choose(path: Path, eps: np.ndarray, needs: Needs, times: int, method: str) -> Needs:
    """Per cell, the way that passes through fewer wells."""
    nodes = np.full(eps.size, _NODES)
    if method == "resolved":
        nodes = np.zeros(eps.size, dtype=int)
    if method == "auto":
        sampled = cost_of(path, eps, needs._replace(nodes=nodes), times)
        every = cost_of(path, eps, needs._replace(nodes=0 * nodes), times)
        nodes = np.where(sampled < every, nodes, 0)
    needs = needs._replace(nodes=nodes)
    outer, _ = wells_of(path, eps, needs)
    return needs._replace(tile=np.maximum(needs.tile, outer / _TILES))


class _Cellwise(NamedTuple):
    """What an attempt needs of each cell."""

    eps: np.ndarray
    ground: Ground
    cells: Cells
    needs: Needs


def _some(parts: Any, chosen: np.ndarray) -> Any:
    return jax.tree_util.tree_map(lambda v: np.asarray(v)[chosen], parts)


def _put(whole: Any, part: Any, chosen: np.ndarray) -> None:
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

    def rounds(self, ground: Ground, cells: Cells) -> Rounds:
        """What rounds of windows of some cells need."""
        parts = self.scene, self.lanes, self.path, ground, cells
        return Rounds(*parts, self.tableau, self.wanted, self.accuracy, self.report)

    def attempt(self, cells: _Cellwise) -> tuple[Answers, np.ndarray]:
        """Answers of some cells, and which of them have a bracket that stays open."""
        rides, whole = cells.ground.rides, any(self.wanted) or self.every_slip
        layout = lay_out(
            self.scene, self.path, cells.eps, self.ts, cells.needs, rides, whole
        )
        rounds = self.rounds(cells.ground, cells.cells)
        found, open_ = collect(rounds, layout, cells.needs)
        start = cells.ground.start_well, cells.ground.start_tip
        answers = evaluate(
            self.scene, self.path, cells.eps, self.ts, layout, found, self.wanted, start
        )
        never = np.zeros(cells.eps.size, dtype=bool)
        never[layout.windows.cell[open_]] = True
        return answers, never

    def is_rough(self, answers: Answers, eps: np.ndarray) -> np.ndarray:
        """Cells whose surveys are not good to the accuracy."""
        rough = answers.survey_error > CLOSED * self.accuracy * eps
        if self.wanted.energies:
            share = answers.survey_work_error > CLOSED * self.accuracy * np.abs(
                answers.dissipation[:, -1]
            )
            rough = rough | share
        return rough


class Planned(NamedTuple):
    """Cells before anything has run: step control, what windows know and need."""

    control: StepPlan
    ground: Ground
    needs: Needs


def planned(
    scene: Scene,
    lanes: LaneScene,
    path: Path,
    eps: np.ndarray,
    gamma: np.ndarray,
    times: int,
    accuracy: float,
    method: str,
) -> Planned:
    """Plan the cells (eps, gamma), shape (cells,), with values at so many times."""
    # The bristle as a series compiles faster too.
    scene = eqx.tree_at(lambda s: s.potential, scene, lanes.potential)
    rho = path.rho_plus, path.rho_minus
    control = _controls(scene, _fixed(eps), _fixed(gamma), accuracy, rho)
    control = _some(control, np.arange(eps.size))
    ground = ground_of(scene, path, eps, gamma, control.folds)
    needs = _needs(control, ground, path, accuracy)
    return Planned(control, ground, _choose(path, eps, needs, times, method))


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
) -> Answers | None:
    """Every cell (eps, gamma), shape (cells,): values at `ts` and sums over [0, T].

    "resolved" measures every slip, in tiles; "windowed" a few periods of every slide that
    is long enough; "auto" what passes through fewer wells. Surveys that are too rough are
    made again with more periods; where brackets stay open, tiles measure every slip; and
    where theirs do too, one lane goes through all. Accuracies looser than 1e-3 are solved
    as that. Where neither energies are `balanced` nor `suprema` wanted, "windowed" and
    "auto" leave out all slips between the times.
    `report` is told the share of each batch of jobs that is done. None where the load
    turns more often than the scene has room for.
    """
    path = path_of(scene)
    if path is None:
        return None
    accuracy = min(accuracy, LOOSEST)
    lanes = lane_scene(scene, float(eps.max()))
    wanted = Sums(energies=balanced, extremes=balanced or suprema)
    _prepare(lanes, eps.size, ts.size, wanted)
    plan = planned(scene, lanes, path, eps, gamma, ts.size, accuracy, method)
    control, ground, needs = plan
    cells = Cells(eps, eps**gamma, control.tolerance, control.reach, control.first_step)
    parts = _Cellwise(eps, ground, cells, needs)
    every = method == "resolved"
    sweep = _Sweep(scene, path, lanes, TABLEAU, ts, accuracy, wanted, every, report)
    if method != "resolved":
        parts = _ridden(sweep, parts, eps**gamma)
    answers, never = sweep.attempt(parts)
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
    tile = np.where(nodes > 0, some.needs.tile, np.maximum(some.needs.tile, wells / _TILES))
    every.needs.nodes[again], every.needs.tile[again] = nodes[can], tile[can]
    part, never[again] = sweep.attempt(_some(every, again))
    _put(answers, part, again)
    return True


def _in_tiles(sweep: _Sweep, every: _Cellwise, answers: Answers, never: np.ndarray) -> None:
    """Every slip in longer tiles, for cells of which a bracket stays open.

    At gamma = 0.75, eps = 1e-4, accuracy 1e-6: 1.5 s, where one lane takes 30.
    """
    chosen = np.flatnonzero(never)
    chosen = chosen[_affordable(sweep.path, _some(every, chosen))]
    if chosen.size == 0:
        return
    some = _some(every, chosen)
    wells = sweep.path.travel[-1] / some.eps
    tile = np.maximum(4 * some.needs.tile, wells / _TILES)
    needs = some.needs._replace(nodes=np.zeros(chosen.size, dtype=int), tile=tile)
    part, open_ = sweep.attempt(some._replace(needs=needs))
    _put(answers, part, chosen)
    never[chosen] = open_


def remembers_long(path: Path, eps: np.ndarray, needs: Needs) -> np.ndarray:
    """Cells that remember too many slips for windows, and have slides worth a map."""
    longest = np.max(np.abs(np.diff(path.states)), initial=0.0) / eps
    return (needs.warm > LONG_MEMORY) & (longest > _LONG_SLIDE)


def _ridden(sweep: _Sweep, every: _Cellwise, viscosity: np.ndarray) -> _Cellwise:
    """The same cells, with the rides of those that remember too many slips for windows."""
    long = remembers_long(sweep.path, every.eps, every.needs)
    if not long.any():
        return every
    rounds = sweep.rounds(every.ground, every.cells)
    find_rides(rounds, np.flatnonzero(long), viscosity, every.needs.warm)
    has = np.array([len(rides) > 0 for rides in every.ground.rides])
    nodes = np.where(has, _NODES, every.needs.nodes)
    return every._replace(needs=every.needs._replace(nodes=nodes))


def _prepare(lanes: LaneScene, cells: int, times: int, wanted: Sums) -> None:
    """Have the loop compiled beside the planning."""
    if cells * times > _FEW:
        legs = cells * times // WORKERS
        prepare(lanes, TABLEAU, Room(cells, legs // 2, legs), wanted)


def _affordable(path: Path, cells: _Cellwise) -> np.ndarray:
    return path.travel[-1] / cells.eps <= _AFFORDABLE


def _from_the_start(
    sweep: _Sweep, every: _Cellwise, answers: Answers, open_: np.ndarray
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
    forever, none = np.full(chosen.size, np.inf), np.zeros(chosen.size)
    needs = some.needs._replace(warm=forever, settle=none, tile=forever, nodes=none)
    part, _ = sweep.attempt(some._replace(needs=needs))
    _put(answers, part, chosen)
