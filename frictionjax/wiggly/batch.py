"""All cells of a sweep through lanes: rounds of brackets until every bracket has closed."""

import numpy as np

from .._checks import quiet_where_extreme, viscosity_of
from ..model import Scene, SummedPotential, tabulated_scene
from ..numerics import concatenated, rows_of
from .attempts import AttemptContext, Cellwise, SoFar, with_rows
from .enclosure import SETTINGS as ENCLOSURE_SETTINGS
from .enclosure import (
    BracketContext,
    CellSlides,
    Report,
    find_fast_slides,
    inner_parts,
    no_effort,
    wells_outside,
)
from .equation import Status
from .lanes import LaneCells, LaneScene, Room, prepare
from .limit_path import SETTINGS as PATH_SETTINGS
from .limit_path import known_path
from .plan import Planned, at_turns, in_phases, lane_scene, planned
from .rosenbrock import Tableau
from .settings import SETTINGS
from .slip_map import none_known
from .sums import CellResults, Sums, nothing_found
from .ways import Way


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
    tableau: Tableau = SETTINGS.tableau,
    phase: np.ndarray | None = None,
) -> CellResults | None:
    """Every cell (eps, gamma), shape (cells,): values at `ts` and sums over [0, T].

    "resolved" measures every slip, in tiles; "windowed" a few periods of every slide that
    is long enough; "auto" what passes through fewer wells. Surveys that are too rough are
    made again with more periods; where brackets stay open, tiles measure every slip, of up
    to 2e5 wells; and where theirs do too, one lane goes through all. Accuracies looser
    than 1e-3 are solved as that. Where neither energies are `balanced` nor `suprema`
    wanted, "windowed" and "auto" leave out all slips between the times.
    `report` is told the share of each batch of jobs that is done. `tableau`: another scheme
    than the lanes' own, to compare with. `phase` (cells,): where on the surface each
    cell's bristle stands, in periods; None: all at 0. None where the load turns more often
    than the scene has room for.
    """

    # A sum is a surface of its own at every eps.
    summed = isinstance(scene.potential, SummedPotential)
    one = [np.arange(eps.size)]
    groups = [np.flatnonzero(eps == e) for e in np.unique(eps)] if summed else one
    parts = []
    for group in groups:
        part = _integrated(
            scene=scene,
            eps=eps[group],
            gamma=gamma[group],
            phase=None if phase is None else phase[group],
            ts=ts,
            accuracy=accuracy,
            method=method,
            wanted=Sums(energies=balanced, extremes=balanced or suprema),
            report=report,
            tableau=tableau,
        )
        if part is None:
            return None
        parts.append(part)
    return rows_of(concatenated(parts), np.argsort(np.concatenate(groups)))


def _integrated(
    scene: Scene,
    eps: np.ndarray,
    gamma: np.ndarray,
    phase: np.ndarray | None,
    ts: np.ndarray,
    accuracy: float,
    method: str,
    wanted: Sums,
    report: Report,
    tableau: Tableau,
) -> CellResults | None:
    tables = tabulated_scene(scene, eps)
    path = known_path(scene, tables)
    if path is None:
        return None
    accuracy = min(accuracy, SETTINGS.loosest)
    lanes = lane_scene(tables)
    _prepare(lanes, eps.size, ts.size, any(wanted), tableau)
    # Bristles of a cell have one plan.
    own = whose = np.arange(eps.size)
    if phase is not None:
        _, own, whose = np.unique(eps + 1j * gamma, return_index=True, return_inverse=True)
    plan = planned(
        scene=tables,
        path=path,
        eps=eps[own],
        gamma=gamma[own],
        times=ts.size,
        accuracy=accuracy,
        method=method,
    )
    if phase is not None:
        plan = in_phases(tables, path, rows_of(plan, whose), phase)
    every = _cells_of(at_turns(path, plan, gamma), eps, gamma)
    rounds = BracketContext(
        scene=tables,
        lanes=lanes,
        path=path,
        ground=every.ground,
        cells=every.cells,
        tableau=tableau,
        summed=any(wanted),
        accuracy=accuracy,
        report=report,
        effort=no_effort(eps.size),
        brief=every.brief,
    )
    sweep = AttemptContext(rounds, ts, wanted, every_slip=method == "resolved")
    so_far = _first_attempt(sweep, every, plan.way == Way.SLIP_MAP)
    answers = so_far.answers._replace(tolerance=np.asarray(plan.control.tolerance))
    so_far = so_far._replace(answers=answers)
    for _ in range(SETTINGS.surveys):
        rough = np.flatnonzero(sweep.is_rough(so_far) & ~so_far.open_)
        if rough.size == 0:
            break
        so_far = _surveyed_again(sweep, so_far, rough)
    so_far = _in_tiles(sweep, so_far)
    return _from_the_start(sweep, so_far).answers


def _cells_of(plan: Planned, eps: np.ndarray, gamma: np.ndarray) -> Cellwise:
    """What the first attempt needs of each cell."""
    steps = plan.control
    return Cellwise(
        ground=plan.ground,
        cells=LaneCells(
            eps=eps,
            viscosity=viscosity_of(eps, gamma),
            **steps.control._asdict(),
        ),
        brief=np.asarray(steps.brief),
        needs=plan.needs,
    )


def _surveyed_again(sweep: AttemptContext, so_far: SoFar, rough: np.ndarray) -> SoFar:
    """Twice as many slips of the `rough` cells, at last all: of many one lane alone."""
    some, path = rows_of(so_far.cells, rough), sweep.rounds.path
    samples = some.needs.samples * 2 * (some.needs.samples < SETTINGS.most_nodes)
    can = some.ground.has_few_wells(path) | (samples > 0)
    alone = some.ground.is_affordable(path)
    so_far = so_far.with_status(rough[~(can | alone)], Status.ROUGH_SURVEY)
    left = with_rows(so_far.open_, rough[alone & ~can], True)
    so_far = so_far._replace(open_=left)
    again = rough[can]
    if again.size == 0:
        return so_far
    wells = path.travel[-1] / some.ground.eps
    longer = np.maximum(some.needs.tile, wells / SETTINGS.tiles)
    tile = np.where(samples > 0, some.needs.tile, longer)
    some = some._replace(needs=some.needs._replace(samples=samples, tile=tile))
    return so_far.with_attempt(sweep.attempt(rows_of(some, can)), again)


def _in_tiles(sweep: AttemptContext, so_far: SoFar) -> SoFar:
    """Every slip in longer tiles, for cells of which a bracket stays open.

    At gamma = 0.75, eps = 1e-4, accuracy 1e-6: 1.5 s, where one lane takes 30. Not where
    one lane may go further than usual: each tile would set off as far back.
    """
    path = sweep.rounds.path
    chosen = np.flatnonzero(so_far.open_ & so_far.cells.ground.has_few_wells(path))
    if chosen.size == 0:
        return so_far
    some = rows_of(so_far.cells, chosen)
    wells = path.travel[-1] / some.ground.eps
    tile = np.maximum(4 * some.needs.tile, wells / SETTINGS.tiles)
    none = np.zeros(chosen.size, dtype=int)
    some = some._replace(needs=some.needs._replace(samples=none, tile=tile))
    return so_far.with_attempt(sweep.attempt(some), chosen)


def _first_attempt(sweep: AttemptContext, every: Cellwise, by_map: np.ndarray) -> SoFar:
    """Answers of all cells; the fast slides of those `by_map` are found before."""
    some = np.flatnonzero(by_map)
    if some.size == 0:
        return _of_what_ends(sweep, every)
    needs = rows_of(every.needs, some)
    found = find_fast_slides(sweep.rounds_of(rows_of(every, some)), needs)
    has = np.array([len(own) > 0 for own in found.slides])
    samples = np.where(has, PATH_SETTINGS.nodes, needs.samples)
    slides = with_rows(every.ground.fast_slides, some, found.slides)
    every = every._replace(
        ground=every.ground._replace(fast_slides=slides),
        needs=every.needs._replace(samples=with_rows(every.needs.samples, some, samples)),
    )
    so_far = _of_what_ends(sweep, every)
    steps, rejected, _ = found.effort()
    answers = so_far.answers
    answers = answers._replace(
        steps=with_rows(answers.steps, some, answers.steps[some] + steps),
        rejected=with_rows(answers.rejected, some, answers.rejected[some] + rejected),
    )
    return so_far._replace(answers=answers)


def _of_what_ends(sweep: AttemptContext, every: Cellwise) -> SoFar:
    """Answers of all cells but those with so many wells outside slides that none comes.

    Those remember long, and slip maps do not know them; what one lane goes through ends.
    """
    ground, path = every.ground, sweep.rounds.path
    wells = path.travel[-1] / ground.eps
    remembered = ground.longest_memory > wells
    most = np.where(
        remembered, ENCLOSURE_SETTINGS.outside_remembered, ENCLOSURE_SETTINGS.outside
    )
    long = (every.needs.run_up > SETTINGS.far_back) & np.isfinite(every.needs.tile)
    some = np.flatnonzero(long & (wells > most))
    if some.size == 0 or sweep.every_slip:
        return sweep.attempt(every)
    its = rows_of(every, some)
    slides = CellSlides(path, its.ground.eps, its.needs, its.ground.fast_slides)
    outside = wells_outside(slides, inner_parts(slides))
    ends = np.delete(np.arange(ground.eps.size), some[outside > most[some]])
    nothing = nothing_found(ground.eps.size, sweep.ts.size)
    so_far = SoFar(every, nothing, np.ones(ground.eps.size, dtype=bool))
    if ends.size == 0:
        return so_far
    return so_far.with_attempt(sweep.attempt(rows_of(every, ends)), ends)


def prepare_cells(scene: Scene, eps: np.ndarray, times: int) -> None:
    """Have the loop for cells of these eps compiled, before `integrate_cells` asks."""
    lanes = lane_scene(tabulated_scene(scene, eps))
    _prepare(lanes, eps.size, times, summed=True)


def _prepare(
    lanes: LaneScene,
    cells: int,
    times: int,
    summed: bool,
    tableau: Tableau = SETTINGS.tableau,
) -> None:
    """Have the loop compiled beside the planning."""
    room, values = Room(cells, 1, 1), cells * times  # the smallest: see `_blocks`
    if values > SETTINGS.few_values:
        prepare(lanes, tableau, room, summed)
    elif values <= SETTINGS.fewest_values:
        prepare(lanes, tableau, room, summed, narrow=True)


def _from_the_start(sweep: AttemptContext, so_far: SoFar) -> SoFar:
    """One lane from z0 through everything, for cells whose brackets stay open."""
    can = so_far.cells.ground.is_affordable(sweep.rounds.path)
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
    some = rows_of(so_far.cells, chosen)
    forever, none = np.full(chosen.size, np.inf), np.zeros(chosen.size)
    needs = some.needs._replace(
        run_up=forever,
        transient=none,
        tile=forever,
        samples=none,
        restarts=np.zeros_like(some.needs.restarts),
    )
    ground = some.ground._replace(fast_slides=none_known(chosen.size))
    part = sweep.attempt(some._replace(ground=ground, needs=needs))
    # Lanes that failed say why.
    left = np.flatnonzero(part.open_ & (part.answers.status == int(Status.OK)))
    return so_far.with_attempt(part.with_status(left, Status.OPEN_BRACKET), chosen)
