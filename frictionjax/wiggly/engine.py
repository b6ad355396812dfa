"""All cells of a sweep through lanes: rounds of windows until every bracket has closed."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Array

from ..arguments import Real
from ..coefficients import Coefficients, coefficients_jit
from ..potentials import AbstractPotential, BristlePotential
from ..profiles import AbstractProfile
from ..programs import Program
from ..scene import Scene
from .evaluation import Answers, Found, evaluate
from .forgetting import lag_forces
from .lanes import Arrivals, Cells, Jobs, LaneScene, Legs, Room, march, prepare
from .layout import Layout, Needs, cost_of, lay_out, wells_of
from .path import Path, path_of, slopes_at, states_at
from .rides import Ride, Rider, Seen, ride_through
from .rodas4p2 import Rodas4P2
from .rodas5p import Rodas5P
from .rosenbrock import Tableau
from .series_bristle import series_of
from .status import Status
from .tolerance import Folds, plan_steps, pull_of
from .tolerance import Plan as StepPlan
from .windows import Ground, Plan, Starts, Windows, gaps_of, plan_windows, starts_of

_WORKERS = 2  # XLA runs each queue of lanes on one core
_CLOSED = 0.5  # of the accuracy: gaps of brackets accepted
_ROUNDS = 3
_EARLIER = 4  # times as far back in each round
_MARGIN = 3  # wells: one to fall behind, one to catch up, one to forget
_LANES = 256  # tiles wanted at least: two queues of 64 lanes that do not run dry
_NODES, _MOST_NODES, _SURVEYS = 17, 65, 3
_BATCH = 1e5  # wells: a few seconds, between two reports
# Wells that one lane alone goes through at most: a minute or two.
_AFFORDABLE = 2e5
_FASTER = 1.5  # how much slides may have been faster, squared, where lanes set off
_TIGHT = 3e-5  # tolerance below which the scheme of order 5 is the cheaper one
_CELLS = 16  # at least, in a compiled call: 64 take 4 ms, 16 one
# Accuracy below which the tolerance is below `_TIGHT`, and values worth a guess at rooms.
_LIKELY_TIGHT, _FEW = 100 * _TIGHT, 500
# Windows that set off so many wells earlier, in slides so long, are worth a slip map.
_LONG_MEMORY, _LONG_SLIDE = 100.0, 300.0
# Tolerance of the lanes that measure a slip map; errors of the map at its start, as lanes
# leave it, and at least, of the accuracy.
_TIGHT_RIDE, _SET_OFF, _LEAST_ERROR = 1e-10, 0.1, 0.01
# Share of the accuracy that rounding of times may take in a measurement of a slip map, and
# wells that lanes go through for it at most.
_NOISE, _MOST_CHECKED = 0.03, 400.0

Report = Callable[[float], None]


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
    size = _CELLS
    while size < values.size:
        size *= 4
    return np.pad(values, (0, size - values.size), mode="edge")


@Program
def _tips(potential: AbstractPotential, z0: Real, eps: Array):
    return jax.vmap(lambda e: potential.tip(z0, e))(eps)


def ground_of(
    scene: Scene, path: Path, eps: np.ndarray, gamma: np.ndarray, folds: Folds
) -> Ground:
    """What windows need to know of each cell."""
    largest = int(np.argmax(eps))
    sharpest = Folds(*(f[largest] for f in folds))
    drag = path.speed * eps**gamma
    lags = lag_forces(scene.potential, float(eps[largest]), sharpest, drag)
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
        rides=_no_rides(eps.size),
    )


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


def _merged(one: Arrivals, other: Arrivals) -> Arrivals:
    """Each leg from the queue that ran it."""
    pairs = zip(one, other, strict=True)
    return Arrivals(*(np.where(np.isnan(a), b, a) for a, b in pairs))


def _nothing(legs: Legs) -> Arrivals:
    return Arrivals(*[np.full(legs.start.size, np.nan)] * len(Arrivals._fields))


class Round(NamedTuple):
    """What one round of windows has found."""

    plan: Plan
    found: Arrivals


class _Engine(NamedTuple):
    """What all rounds of one sweep share."""

    scene: Scene
    lanes: LaneScene
    path: Path
    ground: Ground
    cells: Cells
    tableau: Tableau
    balanced: bool
    accuracy: float
    report: Report

    def run(self, windows: Windows, wells: np.ndarray, back: np.ndarray) -> Round:
        """March all windows, from `wells` of the path or `back` of a ride before them."""
        where = windows.cell, windows.begin, wells, back
        starts = starts_of(self.scene, self.path, self.ground, *where)
        return self.march_from(windows, starts)

    def march_from(self, windows: Windows, starts: Starts) -> Round:
        """March all windows from their starts."""
        plan = plan_windows(self.scene, self.path, self.ground, windows, starts)
        return Round(plan, self._march(plan))

    def _march(self, plan: Plan) -> Arrivals:
        """Deal the jobs to the cores, the longest first."""
        jobs, legs = plan.jobs, plan.legs
        eps = self.ground.eps[jobs.cell]
        way = np.concatenate([[0.0], np.cumsum(np.abs(legs.guide1 - legs.guide0))])
        wells = (way[jobs.past_leg] - way[jobs.first_leg]) / eps
        cost = wells + 1 + 0.3 * (jobs.past_leg - jobs.first_leg)
        order = np.argsort(-cost, kind="stable")
        batches = int(np.ceil(cost.sum() / _BATCH))
        found = _nothing(legs)
        with ThreadPoolExecutor(_WORKERS) as pool:
            for batch in range(batches):
                queues = [
                    order[batch + i * batches :: batches * _WORKERS]
                    for i in range(_WORKERS)
                ]
                for part in pool.map(lambda q: self._queue(jobs, legs, q), queues):
                    found = _merged(found, part)
                self.report(1 / batches)
        return found

    def _queue(self, jobs: Jobs, legs: Legs, chosen: np.ndarray) -> Arrivals:
        if chosen.size == 0:
            return _nothing(legs)
        mine = Jobs(*(np.asarray(column)[chosen] for column in jobs))
        # Rows of this queue's legs only, in the order of its jobs.
        count = mine.past_leg - mine.first_leg
        past = np.cumsum(count)
        rows = np.repeat(mine.first_leg - (past - count), count) + np.arange(count.sum())
        mine = mine._replace(first_leg=past - count, past_leg=past)
        some = Legs(*(column[rows] for column in legs))
        found = march(self.lanes, self.cells, mine, some, self.tableau, self.balanced)
        return Arrivals(*(_spread(v, rows, legs.start.size) for v in found))


def _spread(values: np.ndarray, rows: np.ndarray, size: int) -> np.ndarray:
    out = np.full(size, np.nan)
    out[rows] = values
    return out


def _collect(engine: _Engine, layout: Layout, needs: Needs) -> tuple[Found, np.ndarray]:
    """Rounds of windows, further back each time; and windows that never closed."""
    windows = layout.windows
    size = windows.stop.size
    values = np.full((len(Arrivals._fields), size), np.nan)
    legs = np.full((len(Legs._fields), size), np.nan)
    gap, how = np.full(size, np.inf), np.zeros(size, dtype=int)
    cells = engine.ground.eps.size
    steps, rejected = np.zeros(cells), np.zeros(cells)
    open_ = np.arange(windows.cell.size)
    wells = _run_ups(engine, windows, needs.warm)
    back = np.ones(wells.size)
    for _ in range(_ROUNDS):
        some = windows.chosen(open_)
        place = np.flatnonzero(np.isin(windows.owner, open_))
        place = place[np.argsort(windows.owner[place], kind="stable")]
        plan, found = engine.run(some, wells[open_], back[open_])
        speed = engine.path.speed
        gaps = gaps_of(found, plan.legs, plan.behind, plan.ahead, speed)
        meets = gaps_of(found, plan.legs, plan.meet_behind, plan.meet_ahead, speed)
        # Stops that one lane alone has reached count as closed as their window's begin.
        alone = plan.ahead < 0
        gaps = np.where(alone, meets[some.owner], gaps)
        values[:, place] = np.stack([v[plan.behind] for v in found])
        legs[:, place] = np.stack([v[plan.behind] for v in plan.legs])
        gap[place] = gaps
        how[place] = np.where(plan.known, 0, 1 + plan.ridden)[some.owner]
        owner = np.repeat(plan.jobs.cell, plan.jobs.past_leg - plan.jobs.first_leg)
        steps += np.bincount(owner, np.nan_to_num(found.steps), cells)
        rejected += np.bincount(owner, np.nan_to_num(found.rejected), cells)
        worst = np.zeros(some.cell.size)
        np.maximum.at(worst, some.owner, np.nan_to_num(gaps, nan=np.inf))
        # Lanes that met before a stop part again for a moment where it is at a slip: the
        # start is forgotten all the same, and the gap is reported as it is.
        worst = np.minimum(worst, np.nan_to_num(meets, nan=np.inf))
        open_ = open_[worst > _CLOSED * engine.accuracy]
        if open_.size == 0:
            break
        wells[open_] *= _EARLIER
        back[open_] *= _EARLIER
    result = Found(Arrivals(*values), Legs(*legs), gap, how, steps, rejected)
    return result, open_


def _run_ups(engine: _Engine, windows: Windows, warm: np.ndarray) -> np.ndarray:
    """Wells that each window starts earlier: fewer where its slide is slow, (W,).

    Slides remember in proportion to the square of their speed.
    """
    wells = warm[windows.cell].astype(float)
    if not np.any((wells > _LONG_MEMORY) & np.isfinite(wells)):
        return wells
    near = np.full(wells.size, _MARGIN + 1.0)
    where = windows.cell, windows.begin, near, near
    starts = starts_of(engine.scene, engine.path, engine.ground, *where)
    states = states_at(engine.scene, engine.path, starts.time)
    speeds = slopes_at(engine.scene, engine.path, starts.time, states)
    share = np.minimum(_FASTER * (speeds / engine.path.speed) ** 2, 1.0)
    share = np.where(starts.ridden, 1.0, share)
    return np.ceil(_MARGIN + share * (wells - _MARGIN))


def _needs(control: StepPlan, ground: Ground, path: Path, accuracy: float) -> Needs:
    """How far back windows start: until a bracket as wide as the lag has closed."""
    lag = np.maximum(ground.lag_plus, ground.lag_minus) / ground.eps
    memory = np.asarray(control.memory)[: lag.size]
    folds = np.log((lag + 2) / (0.1 * accuracy))
    warm = np.ceil(_MARGIN + memory * folds)
    settle = np.ceil(lag + warm + 2)
    return Needs(warm, settle, 3 * warm, np.zeros(lag.size), _offsets(ground, path))


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
    return needs._replace(tile=np.maximum(needs.tile, outer.sum() / _LANES))


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
    balanced: bool
    report: Report

    def engine(self, ground: Ground, cells: Cells) -> _Engine:
        """What rounds of windows of some cells need."""
        parts = self.scene, self.lanes, self.path, ground, cells
        return _Engine(*parts, self.tableau, self.balanced, self.accuracy, self.report)

    def attempt(self, cells: _Cellwise) -> tuple[Answers, np.ndarray]:
        """Answers of some cells, and which of them have a bracket that stays open."""
        rides = cells.ground.rides
        layout = lay_out(self.scene, self.path, cells.eps, self.ts, cells.needs, rides)
        engine = self.engine(cells.ground, cells.cells)
        found, open_ = _collect(engine, layout, cells.needs)
        start = cells.ground.start_well, cells.ground.start_tip
        answers = evaluate(
            self.scene, self.path, cells.eps, self.ts, layout, found, self.balanced, start
        )
        never = np.zeros(cells.eps.size, dtype=bool)
        never[layout.windows.cell[open_]] = True
        return answers, never

    def is_rough(self, answers: Answers, eps: np.ndarray) -> np.ndarray:
        """Cells whose surveys are not good to the accuracy."""
        rough = answers.survey_error > _CLOSED * self.accuracy * eps
        if self.balanced:
            share = answers.survey_work_error > _CLOSED * self.accuracy * np.abs(
                answers.dissipation[:, -1]
            )
            rough = rough | share
        return rough


def integrate_cells(
    scene: Scene,
    eps: np.ndarray,
    gamma: np.ndarray,
    ts: np.ndarray,
    accuracy: float,
    method: str,
    balanced: bool = True,
    report: Report = lambda share: None,
) -> Answers | None:
    """Every cell (eps, gamma), shape (cells,): values at `ts` and sums over [0, T].

    "resolved" measures every slip, in tiles; "windowed" a few periods of every slide that
    is long enough; "auto" what passes through fewer wells. Surveys that are too rough are
    made again with more periods; where brackets stay open, one lane goes through all.
    `report` is told the share of each batch of jobs that is done. None where the load
    turns more often than the scene has room for.
    """
    path = path_of(scene)
    if path is None:
        return None
    lanes = lane_scene(scene, float(eps.max()))
    _prepare(lanes, eps.size, ts.size, accuracy, balanced)
    # The bristle as a series compiles faster too.
    smooth = eqx.tree_at(lambda s: s.potential, scene, lanes.potential)
    rho = path.rho_plus, path.rho_minus
    control = _controls(smooth, _fixed(eps), _fixed(gamma), accuracy, rho)
    control = _some(control, np.arange(eps.size))
    ground = ground_of(scene, path, eps, gamma, control.folds)
    needs = _choose(path, eps, _needs(control, ground, path, accuracy), ts.size, method)
    scheme = Rodas5P if np.min(control.tolerance) < _TIGHT else Rodas4P2
    cells = Cells(eps, eps**gamma, control.tolerance, control.reach, control.first_step)
    every = _Cellwise(eps, ground, cells, needs)
    sweep = _Sweep(scene, path, lanes, scheme.tableau, ts, accuracy, balanced, report)
    if method != "resolved":
        every = _ridden(sweep, every, eps**gamma)
    answers, never = sweep.attempt(every)
    answers = answers._replace(tolerance=control.tolerance)
    for _ in range(_SURVEYS):
        rough = np.flatnonzero(sweep.is_rough(answers, eps) & ~never)
        if rough.size == 0:
            break
        some = _some(every, rough)
        nodes = some.needs.nodes * 2 * (some.needs.nodes < _MOST_NODES)
        every.needs.nodes[rough] = np.where(
            _affordable(path, some) | (nodes > 0), nodes, -1
        )
        again = rough[every.needs.nodes[rough] >= 0]
        answers.status[rough[every.needs.nodes[rough] < 0]] = int(Status.ROUGH_SURVEY)
        if again.size == 0:
            break
        part, open_ = sweep.attempt(_some(every, again))
        _put(answers, part, again)
        never[again] = open_
    _from_the_start(sweep, every, answers, np.flatnonzero(never))
    return answers


def _ridden(sweep: _Sweep, every: _Cellwise, viscosity: np.ndarray) -> _Cellwise:
    """The same cells, with the rides of those that remember too many slips for windows."""
    longest = np.max(np.abs(np.diff(sweep.path.states)), initial=0.0) / every.eps
    long = (every.needs.warm > _LONG_MEMORY) & (longest > _LONG_SLIDE)
    if not long.any():
        return every
    engine = sweep.engine(every.ground, every.cells)
    find_rides(engine, np.flatnonzero(long), viscosity, every.needs.warm)
    has = np.array([len(rides) > 0 for rides in every.ground.rides])
    nodes = np.where(has, _NODES, every.needs.nodes)
    return every._replace(needs=every.needs._replace(nodes=nodes))


def find_rides(
    engine: _Engine, cells: np.ndarray, viscosity: np.ndarray, warm: np.ndarray
) -> None:
    """Put the rides of some cells into the engine's ground."""
    ground, folds = engine.ground, engine.ground.folds
    sides = {
        1.0: (np.asarray(folds.place_plus), np.asarray(folds.force_plus)),
        -1.0: (np.asarray(folds.place_minus), np.asarray(folds.force_minus)),
    }
    rider = Rider(engine.scene, engine.path, ground.eps, viscosity, sides, engine.accuracy)

    def look(cell: np.ndarray, begin: np.ndarray, stop: np.ndarray) -> Seen:
        paired, one = np.ones(cell.size, dtype=bool), np.arange(cell.size)
        windows = Windows(cell, np.minimum(begin, stop), paired, one, stop)
        wells, back = _run_ups(engine, windows, warm), np.ones(cell.size)
        for _ in range(_ROUNDS):
            plan, found = engine.run(windows, wells, back)
            seen = Seen(*_at_stops(engine, plan, found, cell))
            if np.all(seen.gap <= _SET_OFF * engine.accuracy):
                break
            wells, back = wells * _EARLIER, back * _EARLIER
        return seen

    def check(cells, rides, gaps) -> list[np.ndarray]:
        return _errors(engine, cells, rides, gaps)

    def keep(cell: int, ride: Ride) -> None:
        ground.rides[cell] = (*ground.rides[cell], ride)

    ride_through(rider, cells, look, check, keep)


def _at_stops(engine: _Engine, plan: Plan, found: Arrivals, cell: np.ndarray):
    """Well, tip and gap in wells of time at the one stop of each window."""
    a, b = plan.behind, np.maximum(plan.ahead, 0)
    way = (found.well[b] - found.well[a]) + (found.tip[b] - found.tip[a])
    gap = np.where(plan.ahead >= 0, np.abs(way), 0.0)
    pace = np.abs(found.speed[a]) / engine.path.speed
    gap = np.where(np.isnan(gap), np.inf, gap / np.clip(pace, 1e-300, 1.0))
    return found.well[a], found.tip[a], gap


def _wells_checked(engine: _Engine, cell: int, ride: Ride) -> np.ndarray:
    """Wells that lanes go through on each panel: more where rounding of times adds up."""
    curve = ride.curve
    length = np.diff(curve.starts) / np.diff(curve.edges)
    noise = np.finfo(float).eps * curve.starts[1:] / length
    memory = 1 / np.maximum(np.abs(1 - curve.kept), 1e-12)
    wanted = noise * memory / (_NOISE * engine.accuracy)
    return np.minimum(np.clip(np.ceil(wanted), 2, _MOST_CHECKED), np.diff(curve.edges))


def _errors(
    engine: _Engine, cells: list[int], rides: list[Ride], gaps: list[float]
) -> list[np.ndarray]:
    """Errors in the tip on the panels of rides: what lanes find in some wells, summed up.

    Counted in wells of time, which are as many periods of the tip as it is slow there.
    `gaps`: of each ride's start, in wells of time.
    """
    pairs = list(zip(cells, rides, strict=True))
    number = [ride.curve.edges[:-1] for ride in rides]
    wells = [_wells_checked(engine, cell, ride) for cell, ride in pairs]
    begin = [r.curve.time_of(n) for r, n in zip(rides, number, strict=True)]
    past = [n + w for n, w in zip(number, wells, strict=True)]
    stop = [r.curve.time_of(n) for r, n in zip(rides, past, strict=True)]
    tips = [np.full(n.size, r.tip) for r, n in zip(rides, number, strict=True)]
    well = np.concatenate([r.wells_at(n) for r, n in zip(rides, number, strict=True)])
    aim = np.concatenate([r.wells_at(n) for r, n in zip(rides, past, strict=True)])
    sizes = [n.size for n in number]
    begin_, stop_, tip, count = (np.concatenate(c) for c in (begin, stop, tips, wells))
    whose, known = np.repeat(cells, sizes), np.ones(tip.size, dtype=bool)
    starts = Starts(begin_, known, ~known, well, tip, well, tip)
    tight = np.where(np.isin(np.arange(engine.ground.eps.size), cells), _TIGHT_RIDE, 1.0)
    tight = np.minimum(tight, engine.cells.tolerance)
    exact = engine._replace(cells=engine.cells._replace(tolerance=tight))
    windows = Windows(whose, begin_, known, np.arange(tip.size), stop_)
    plan, found = exact.march_from(windows, starts)
    at = plan.behind
    place = found.well[at] + (found.tip[at] - tip) - aim
    # In wells of time: at its fold the tip is far slower than on the average.
    pace = np.abs(found.speed[at]) * (stop_ - begin_) / (count * engine.ground.eps[whose])
    drift = np.abs(place) / np.maximum(pace, 1e-300) / count
    ends = np.cumsum(sizes)[:-1]
    parts = zip(rides, np.split(drift, ends), np.split(pace, ends), gaps, strict=True)
    return [_summed(engine, *part) for part in parts]


def _summed(engine: _Engine, ride: Ride, drift, pace, gap: float) -> np.ndarray:
    """Errors that grow by `drift` a well and are forgotten as shifts in time are."""
    curve = ride.curve
    error, errors = max(gap, _SET_OFF * engine.accuracy), []
    for k, wells in enumerate(np.diff(curve.edges)):
        left = curve.kept[k] ** wells
        grown = (1 - left) / (1 - curve.kept[k]) if curve.kept[k] != 1 else wells
        after = error * left + drift[k] * grown + curve.tail[k]
        errors.append(max(error, after, _LEAST_ERROR * engine.accuracy))
        error = after
    return np.array(errors) * np.minimum(pace, 1.0)


def _prepare(lanes: LaneScene, cells: int, times: int, accuracy: float, balanced) -> None:
    """Have the loop compiled beside the planning, where its scheme is known already."""
    if accuracy < _LIKELY_TIGHT and cells * times > _FEW:
        legs = cells * times // _WORKERS
        prepare(lanes, Rodas5P.tableau, Room(cells, legs // 2, legs), balanced)


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
