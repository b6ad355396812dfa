"""What each cell's brackets need, and which way is the cheapest, before anything runs."""

from typing import NamedTuple

import jax
import numpy as np

from .._checks import Real, exchanged, viscosity_of
from .._compile import Program, in_chunks, once_a_scene
from ..model import AbstractPotential, BristlePotential, TabulatedScene
from ..tables import bent_part, unsampled
from .enclosure import SETTINGS as ENCLOSURE_SETTINGS
from .enclosure import (
    CellBounds,
    Requirements,
    forgotten_after,
    resting_after,
    side_column,
    wells_a_leg,
    wells_of,
)
from .equation import SETTINGS as STEP_SETTINGS
from .equation import PullRange, SteppedParts, plan_steps
from .equation import StepPlan as StepPlan
from .lane_steps import affordable_wells
from .lanes import LaneScene
from .limit_path import SETTINGS as PATH_SETTINGS
from .limit_path import Path, nearness_at_turns, slow_ends
from .settings import SETTINGS
from .slip_map import (
    SteadyLags,
    Wells,
    latest_landings,
    none_known,
    steady_lags,
    wells_both_ways,
)
from .ways import Way, by_brackets, ends_before_tips_follow, ways_of


@once_a_scene
def _plans(parts: SteppedParts, pull: PullRange, accuracy, eps, gamma):
    """Step control of cells, and the wells and tips of their z0."""

    def one(eps: Real, gamma: Real):
        plan = plan_steps(parts, eps, gamma, accuracy, pull)
        return plan, parts.potential.tip(parts.z0, eps)

    return jax.lax.map(lambda cell: one(*cell), (eps, gamma))


def _controls(scene: TabulatedScene, path: Path, eps, gamma, accuracy: float):
    """Step control of all cells, and the wells and tips of their z0."""
    parts = SteppedParts(
        potential=scene.potential,
        support=scene.support,
        duration=np.asarray(scene.duration),
        z0=np.asarray(scene.z0),
    )
    fixed = parts, path.pull, np.asarray(accuracy)
    return in_chunks(_plans, SETTINGS.cells, fixed, (eps, gamma))


def ground_of(
    scene: TabulatedScene,
    path: Path,
    eps: np.ndarray,
    gamma: np.ndarray,
    control: StepPlan,
    start: tuple[np.ndarray, np.ndarray],
) -> CellBounds:
    """What brackets need to know of each cell; `start`: well and tip of its z0."""
    folds, drag = control.folds, path.speed * viscosity_of(eps, gamma)
    wells = wells_both_ways(scene.potential, eps, folds)
    lags, powers = _lags(wells, drag)
    forces = np.stack([folds.force_plus, folds.force_minus], axis=1)
    shifts = np.abs(forces - [path.rho_plus, path.rho_minus]) / path.stiffness
    pulls = eps * path.stiffness, eps * path.stiffest
    landed = latest_landings(wells, lags.force / pulls[0], drag, *pulls)
    lag = lags.force.max(axis=0) / pulls[0]
    return CellBounds(
        eps,
        folds,
        lags=lags.force.T / path.stiffness,
        powers=powers.T,
        memories=(lags.power * lags.force).T / path.stiffness,
        shifts=shifts,
        landed=landed.T,
        start_well=start[0],
        start_tip=start[1],
        relaxed=_relaxation(path, eps, gamma),
        affordable=affordable_wells(path, control, lag, eps, gamma),
        phase=np.zeros(eps.size),
        fast_slides=none_known(eps.size),
        at_turns=np.full((eps.size, path.edges.size - 2), np.inf),
    )


def _lags(wells: Wells, drag: np.ndarray) -> tuple[SteadyLags, np.ndarray]:
    """Lags of the fastest slide, and powers of the speed that bound those of slower ones.

    2 where folds have a curvature and tips nearly rest, p/(p - 1) where W' falls off like
    the power p, 1 where flanks are straight or lags larger than the well's forces.
    """
    both = steady_lags(wells, np.stack([drag, SETTINGS.slower * drag]))
    lags, slower = (SteadyLags(*part) for part in zip(*both, strict=True))
    powers = np.log(lags.force / slower.force) / -np.log(SETTINGS.slower)
    return lags, np.where(powers > SETTINGS.square, 2.0, np.maximum(powers, 1.0))


def _relaxation(path: Path, eps: np.ndarray, gamma: np.ndarray):
    """Time in s until z0 is within a thousandth of a well of the strip (Lemma 7)."""
    efolds = np.log(np.maximum(path.outside / (SETTINGS.near_strip * eps), 1.0))
    return efolds * viscosity_of(eps, gamma) / path.stiffness


def lane_scene(scene: TabulatedScene) -> LaneScene:
    """The scene as lanes see it, who take no samples: one loop, however many it needs."""
    potential = scene.lane_potential
    if isinstance(potential, BristlePotential):
        profile = unsampled(potential.profile)
        potential = exchanged(potential, {"profile": profile})
    rho = np.asarray(scene.rho_plus), np.asarray(scene.rho_minus)
    return LaneScene(potential, scene.support, bent_part(scene.load), *rho)


def _needs(path: Path, ground: CellBounds, accuracy: float) -> Requirements:
    """How far back brackets start: until one as wide as the lag has closed.

    (The closed form of step control is that for one fold far below the others: on the
    angular scene of the benchmarks, gamma = 1/2, memory was a third of it at eps = 1e-3,
    and 119 of 354 brackets stayed open.)
    """
    lag, shift = ground.longest_lag, ground.shifts.max(axis=1) / ground.eps
    forgets, slow = forgotten_after(lag, ground.longest_memory, accuracy)
    landed = ground.landed.max(axis=1)
    run_up = np.minimum(slow, resting_after(lag, landed, shift, forgets))
    offset = _lattice_offsets(ground, path)
    return Requirements(
        run_up=run_up,
        transient=np.ceil(lag + run_up + 2),
        tile=SETTINGS.tile * slow,
        share=_shares(path, ground, run_up),
        samples=np.zeros(lag.size),
        lattice_offset=offset,
        restarts=np.zeros(offset.shape, dtype=bool),
        settles=np.isfinite(landed),
        leg=wells_a_leg(
            path, ground.eps, ground.affordable / ENCLOSURE_SETTINGS.affordable
        ),
    )


def _shares(path: Path, ground: CellBounds, run_up: np.ndarray) -> np.ndarray:
    """Of what the slides need that remember longest, for each piece, (cells, pieces).

    Slides one way may remember less than those the other way, unless the one before ends
    so fast that it is remembered. Where little is remembered all pieces are alike.
    """
    share = np.ones((run_up.size, path.direction.size))
    some = np.flatnonzero(run_up > ENCLOSURE_SETTINGS.some_memory)
    if some.size == 0:
        return share
    slow = _slow_ends(path, ground, some)
    own = ground.memory(some[:, None], path.direction[None, :])
    own = own / np.maximum(ground.longest_memory[some, None], 1e-300)
    before = np.zeros(some.size)
    for piece in np.flatnonzero(path.direction):
        share[some, piece] = np.maximum(own[:, piece], before)
        before = np.where(slow[:, piece], 0.0, own[:, piece])
    margin = ENCLOSURE_SETTINGS.margin / run_up[some, None]
    share[some] = margin + (1 - margin) * share[some]
    return share


def _slow_ends(path: Path, ground: CellBounds, some: np.ndarray) -> np.ndarray:
    """Whether pieces should end slow in some cells, (some, pieces).

    Slides remember twice the wells that they lag by, at most.
    """
    cell, direction = some[:, None], path.direction[None, :]
    lag = ground.lags[cell, side_column(direction)]
    eps, power = ground.eps[some], ground.power(cell, direction)
    return slow_ends(path, eps, 2 * lag / eps[:, None], power)


def _lattice_offsets(ground: CellBounds, path: Path) -> np.ndarray:
    """From each slide's start to half a period behind a fold, in wells, (cells, pieces)."""
    folds, up = ground.folds, path.direction > 0
    fold = np.where(up, folds.state_plus[:, None], folds.state_minus[:, None])
    past = path.direction * (path.states[:-1] - fold) / ground.eps[:, None]
    return np.mod(0.5 - past, 1.0)


def _with_brackets(
    path: Path, eps: np.ndarray, needs: Requirements, brackets: np.ndarray
) -> Requirements:
    """What cells need that go by brackets: how many slips are sampled, and longer tiles."""
    samples = np.where(brackets == Way.SAMPLED, PATH_SETTINGS.nodes, 0)
    needs = needs._replace(samples=samples)
    outer, _ = wells_of(path, eps, needs)
    return needs._replace(tile=np.maximum(needs.tile, outer / SETTINGS.tiles))


def _along(
    path: Path,
    ground: CellBounds,
    needs: Requirements,
    follows: np.ndarray,
    way: np.ndarray,
) -> Requirements:
    """What cells need on their way: one lane, and slip maps, set off where slides end slow.

    One lane does not where slides are over before tips follow.
    """
    alone, by_map = way == Way.ONE_LANE, way == Way.SLIP_MAP
    if not np.any(alone | by_map):
        return needs
    late = ends_before_tips_follow(path, ground, follows)
    restarts = _slow_ends(path, ground, np.arange(ground.eps.size))
    return needs._replace(
        samples=np.where(alone, 0, needs.samples),
        tile=np.where(alone, np.inf, needs.tile),
        restarts=restarts & (by_map | (alone & ~late))[:, None],
    )


class Planned(NamedTuple):
    """Cells before anything has run: step control, what brackets know and need.

    `way`: of each cell, as `Way`.
    """

    control: StepPlan
    ground: CellBounds
    needs: Requirements
    way: np.ndarray


@Program
def _tips(potential: AbstractPotential, states, eps):
    return jax.vmap(potential.tip)(states, eps)


def in_phases(scene: TabulatedScene, path: Path, plan: Planned, phase: np.ndarray):
    """Plans of bristles that stand elsewhere on the surface, `phase` in periods, (cells,).

    `V_eps(z + eps phase)`: all is as at z + eps phase but for the number of the well.
    """
    ground, folds = plan.ground, plan.ground.folds
    ahead = ground.eps * phase
    at = scene.z0 + ahead
    well, tip = in_chunks(_tips, SETTINGS.phases, (scene.potential,), (at, ground.eps))
    offset = plan.needs.lattice_offset - path.direction * phase[:, None]
    return plan._replace(
        ground=ground._replace(
            folds=folds._replace(
                state_plus=folds.state_plus - ahead, state_minus=folds.state_minus - ahead
            ),
            start_well=well - phase,
            start_tip=tip,
            phase=phase,
        ),
        needs=plan.needs._replace(lattice_offset=np.mod(offset, 1.0)),
    )


def at_turns(path: Path, plan: Planned, gamma: np.ndarray) -> Planned:
    """Plans in which lanes err by less than they come near a slip where the load turns.

    (All lanes of such cells: twice the steps at eps = 1e-8, five times at gamma = 2.)
    """
    ground, steps = plan.ground, np.asarray(plan.control.tolerance)
    viscosity, near = viscosity_of(ground.eps, gamma), steps / STEP_SETTINGS.fold
    found = nearness_at_turns(path, ground.folds, ground.eps, viscosity, near)
    # In octaves: lanes alike share a row of their loop.
    most = np.exp2(np.floor(np.log2(STEP_SETTINGS.fold * found)))
    return plan._replace(ground=ground._replace(at_turns=most))


def planned(
    scene: TabulatedScene,
    path: Path,
    eps: np.ndarray,
    gamma: np.ndarray,
    times: int,
    accuracy: float,
    method: str,
) -> Planned:
    """Plan the cells (eps, gamma), shape (cells,), with values at so many times."""
    control, start = _controls(scene, path, eps, gamma, accuracy)
    ground = ground_of(scene, path, eps, gamma, control, start)
    needs = _needs(path, ground, accuracy)
    brackets = by_brackets(path, eps, needs, times, method)
    needs = _with_brackets(path, eps, needs, brackets)
    follows = viscosity_of(eps, gamma) / path.stiffness
    way = ways_of(
        path=path,
        ground=ground,
        needs=needs,
        reach=np.asarray(control.reach),
        follows=follows,
        brackets=brackets,
        method=method,
    )
    needs = _along(path, ground, needs, follows, way)
    return Planned(control, ground, needs, way)
