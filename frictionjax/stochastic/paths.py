"""Paths of the wiggly system with noise, one for each key."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, UInt32
from scipy import special

from .._checks import (
    CodedResult,
    Outcome,
    Real,
    checked,
    is_concrete,
    require,
    require_numbers,
    require_real,
    viscosity_of,
    with_nan,
)
from .._compile import Interpreted, in_chunks, padded_size
from ..effects import Noise
from ..loads import AbstractPull
from ..model import (
    AbstractPotential,
    Scene,
    composed,
    known_scene,
    require_reach,
    require_times,
    require_told_apart,
)
from ..supports import AbstractSupport
from ..tables import load_table
from .force_table import TabulatedForce, tabulated_force
from .path_loop import Bath, run_lanes
from .path_steps import PathSteps, steps_of_paths
from .settings import SETTINGS


class PathStatus(Outcome):
    """Why a path can or cannot be trusted; `message` says it for people."""

    OK = 0, "every number can be trusted"
    NOT_FINITE = 1, "not finite: the support is stiffer where noise took the tip"


class NoisyPaths(CodedResult, eqx.Module):
    """Paths of one cell: `ts` (times,) in s, `z` (paths, times) in m.

    `work` (paths, times): `-int l' z` until then in J, what the load has added to the
    energy `Phi - l z + V_eps`; that at the start, and work, less that then, went into the
    bath.
    Values are those of the step nearest to each time, of `steps` steps in all of the length
    `step` (s): nothing is interpolated, which would take noise out.
    """

    ts: Float[np.ndarray, " times"]
    z: Float[np.ndarray, "paths times"]
    work: Float[np.ndarray, "paths times"]
    step: float
    steps: int
    _outcomes = PathStatus

    @property
    def _codes(self) -> Any:
        good = np.all(np.isfinite(self.z) & np.isfinite(self.work), axis=1)
        return np.where(good, int(PathStatus.OK), int(PathStatus.NOT_FINITE))

    def _in_words(self) -> str:
        paths, times = self.z.shape
        return (
            f"NoisyPaths({self._ended}: {paths} paths, {times} times, {self.steps} steps)"
        )


class MeanInterval(NamedTuple):
    """Mean over paths, and the interval that holds the mean of all with 95% confidence."""

    mean: Float[np.ndarray, " times"]
    low: Float[np.ndarray, " times"]
    high: Float[np.ndarray, " times"]


def mean_interval(values: Float[np.ndarray, "paths times"]) -> MeanInterval:
    """Of independent paths, by Student's t; infinite for one path alone."""
    count = values.shape[0]
    mean = np.mean(values, axis=0)
    if count == 1:
        return MeanInterval(mean, np.full_like(mean, -np.inf), np.full_like(mean, np.inf))
    quantile = special.stdtrit(count - 1, 0.5 + 0.5 * SETTINGS.confidence)
    half = quantile * np.std(values, axis=0, ddof=1) / np.sqrt(count)
    return MeanInterval(mean, mean - half, mean + half)


class NoisyCell(NamedTuple):
    """One cell: what moves, in which bath. Known numbers.

    `duration` in s, `eps` in m, `viscosity` (eps^gamma) in N s/m, `temperature` (T_eps) in
    J.
    """

    potential: AbstractPotential
    support: AbstractSupport
    load: AbstractPull
    duration: float
    eps: float
    viscosity: float
    temperature: float


def run_paths(
    cell: NoisyCell,
    ts: Float[np.ndarray, " times"],
    keys: UInt32[np.ndarray, "paths words"],
    z0: Float[np.ndarray, " paths"],
) -> NoisyPaths:
    """A path from each `z0` (m) with its key, at sorted times in [0, duration].

    Paths go through the loop in rows of the same length, whatever their number: each has
    the same bits in any company.
    """
    force, plan, bath = cell_loop(cell)
    nearest = plan.nearest(ts)
    # Rooms for times: another number of them compiles nothing.
    wanted = np.full(padded_size(ts.size, SETTINGS.times), nearest[-1])
    wanted[: ts.size] = nearest
    fixed = (
        force.table,
        cell.support,
        load_table(cell.load),
        bath,
        wanted,
    )
    found = in_chunks(run_lanes, SETTINGS.lanes, fixed, (keys, z0))
    z, work = (values[:, : ts.size] for values in found)
    return NoisyPaths(ts, z, work, plan.step, plan.total)


def cell_loop(cell: NoisyCell) -> tuple[TabulatedForce, PathSteps, Bath]:
    """What loops of steps are given of a cell: its force in a table, steps, bath."""
    force = tabulated_force(cell.potential, cell.eps)
    plan = _planned(cell, force)
    bath = Bath(
        eps=jnp.asarray(cell.eps),
        viscosity=jnp.asarray(cell.viscosity),
        temperature=jnp.asarray(cell.temperature),
        step=jnp.asarray(plan.step),
    )
    return force, plan, bath


def steps_of_path(scene: Scene, noise: Noise, *, eps: float, gamma: float) -> int:
    """How many steps a path takes; raises `ValueError` as `noisy_paths` does."""
    _, cell, _ = checked_cell(scene, noise, eps, gamma, None)
    return cell_loop(cell)[1].total


def _planned(cell: NoisyCell, force: TabulatedForce) -> PathSteps:
    strongest = 2 * max(force.highest, -force.lowest)
    times = np.linspace(0.0, cell.duration, SETTINGS.moments)
    parts = cell.support, load_table(cell.load), np.asarray(strongest), times
    return steps_of_paths(
        force,
        float(_stiffest(*parts)),
        eps=cell.eps,
        viscosity=cell.viscosity,
        temperature=cell.temperature,
        duration=cell.duration,
    )


@Interpreted
def _stiffest(
    support: AbstractSupport,
    load: AbstractPull,
    margin: Real,
    times: Float[Array, " moments"],
) -> Real:
    """Largest Phi'' in N/m where the load and a friction of `margin` (N) lead."""
    loads = jax.vmap(load)(times)
    forces = jnp.concatenate([loads - margin, loads, loads + margin])
    return jnp.max(jax.vmap(lambda f: support.stiffness_at(support.state_of(f)))(forces))


@with_nan
def noisy_paths(
    scene: Scene,
    noise: Noise,
    *,
    eps: float,
    gamma: float,
    keys: UInt32[np.ndarray, "paths words"],
    ts: Any = None,
    z0: Any = None,
) -> NoisyPaths:
    """Paths of a scene with noise at one eps and gamma (Leimkuhler and Matthews).

    `keys`: as `path_keys` makes them, one a path; `ts`: times in s, not decreasing, in
    [0, duration], 201 even ones where None; `z0`: where paths start, a number or (paths,),
    in m; the scene's own where None.

    Raises `ValueError` for bad numbers, an eps that the bristle does not allow or whose
    wells floats do not tell apart, and where a path takes more than 2^31 steps.
    """
    scene, cell, times = checked_cell(scene, noise, eps, gamma, ts)
    start = scene.z0 if z0 is None else z0
    require_numbers("z0", start, "finite positions in m", lambda v: np.isfinite(v))
    start = np.asarray(start, dtype=float)
    fits = start.shape in ((), (len(keys),))
    require(fits, "z0", f"shape {start.shape}", f"one number, or shape ({len(keys)},)")
    return run_paths(cell, times, keys, np.broadcast_to(start, (len(keys),)))


def checked_cell(
    scene: Scene, noise: Noise, eps: float, gamma: float, ts: Any
) -> tuple[Scene, NoisyCell, Float[np.ndarray, " times"]]:
    """A scene with effects of the potential worked in, what moves of it, and its times."""
    scene, noise = composed(known_scene(scene)), checked(noise)
    known = is_concrete(scene, noise, eps, gamma, ts)
    require(known, "noise", "traced numbers", "known ones: paths have no derivatives")
    require_real("eps", eps, "eps > 0 in m", lambda v: v > 0)
    require_real("gamma", gamma, "a number > 0", lambda v: v > 0)
    require_reach(scene.potential, eps)
    require_told_apart(scene, eps)
    times = np.asarray(require_times(scene, ts))
    cell = NoisyCell(
        potential=scene.potential,
        support=scene.support,
        load=scene.load,
        duration=float(scene.duration),
        eps=float(eps),
        viscosity=float(viscosity_of(eps, gamma)),
        temperature=float(noise.temperature_at(eps)),
    )
    return scene, cell, times
