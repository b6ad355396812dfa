"""A fit to a trace, checked: samples as states, and programs of the coefficients."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from ..._checks import as_real, kind_of, require
from ..._compile import Program, in_chunks, padded_size
from ...bristles import AbstractBristle
from ...loads import AbstractPull
from ...model import BristlePotential, Scene, require_times, scene_on_edges
from ...supports import AbstractSupport
from ...tables import SeriesBristle, bristle_series, in_one_size
from ...wiggly import pulls_at
from ..measured_trace import Trace
from .flow import Flow, bumped_flow, flow, plan_of, waves_of_numbers, with_profile
from .gauss_newton import TraceSamples
from .passed import Passages, held, passages_of
from .settings import SETTINGS
from .start import Read, Reading, read, read_residuals
from .weights import bumps_of


class SurfaceLimits(NamedTuple):
    """Of surfaces that are tried: slopes between, and height in periods."""

    lower: np.ndarray
    upper: np.ndarray
    height: np.ndarray


class TraceProblem(NamedTuple):
    """A checked fit: trace as states, and programs of the coefficients.

    `scene`: in tables, so that programs for it serve all scenes, its surface still flat.
    `noise`: of which passages are known, in terms of the samples' own errors.
    """

    scene: Scene
    limits: SurfaceLimits
    eps: Any
    gamma: Any
    accuracy: Any
    ts: np.ndarray
    reading: Reading
    rough: Reading
    sliding: float
    penalty: np.ndarray
    passages: Passages
    half: float
    noise: float = 1.0

    def held(self, numbers: np.ndarray, rough: float | None = None):
        """Excess over what passages allow, and its derivative, in `rough` of the forces."""
        rough = SETTINGS.start_rough if rough is None else rough
        found = held(self.passages, self.scene, self.eps, numbers)
        return found.r / (rough * self.half), found.by / (rough * self.half)

    def with_noise(self, noise: float) -> "TraceProblem":
        """The same with the passages that samples `noise` times as rough still show."""
        z, sd = self.reading.z, noise * self.reading.sd
        parts = self.scene, self.ts[: z.size], z, sd, float(self.eps)
        return self._replace(passages=passages_of(*parts), noise=noise)

    def run(self, numbers: np.ndarray) -> Flow:
        """Trajectory at the trace's times and its derivatives, as arrays of NumPy."""
        found = flow(*self._programmed(numbers))
        return _cut(found, self.reading.z.size)

    def read(self, numbers: np.ndarray) -> Read:
        """The equation at the samples."""
        return read_residuals(self.reading, self.scene, self.eps, numbers)

    def run_bumps(self, numbers: np.ndarray) -> Flow:
        """The same with derivatives by local bumps."""
        centres, width = bumps_of(numbers.size // 2)
        found = bumped_flow(centres, np.asarray(width), *self._programmed(numbers))
        return _cut(found, self.reading.z.size)

    def _programmed(self, numbers: np.ndarray) -> tuple:
        known = self.scene, self.eps, self.gamma
        return numbers, *known, self.ts, plan_of(numbers, *known, self.accuracy)

    def tips(self, numbers: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Phases of the tip, in periods, at states z."""
        fixed = numbers, self.scene, self.eps
        found = in_chunks(_tips, SETTINGS.together, fixed, (z,))
        return found - np.floor(found)

    def unheld(self) -> np.ndarray:
        """States under the load alone, without friction."""
        load = pulls_at(self.scene, self.ts, np.zeros_like(self.ts)).load
        return states_under(self.scene, load)

    def quantity_of(self, quantity: str, z: np.ndarray) -> np.ndarray:
        """What the trace measures, at states z."""
        if quantity == "z":
            return z
        found = pulls_at(self.scene, self.ts[: z.size], z)
        return found.load - found.force

    def admissible(self, numbers: np.ndarray) -> bool:
        """Whether the bristle follows the surface, with a margin."""
        return bool(_follows(numbers, self.scene, self.eps, self.limits))

    def observed(self) -> TraceSamples:
        """The samples as the descent sees them."""
        eps = float(self.eps)
        return TraceSamples(
            self.reading.z, self.reading.sd, eps, self.sliding, self.penalty
        )


def _cut(found: Flow, count: int) -> Flow:
    found = jax.device_get(found)
    return Flow(found.z[:count], found.speed[:count], found.by[:, :count], found.steps)


@Program
def _follows(numbers: Array, scene: Scene, eps: Any, limits: SurfaceLimits) -> Array:
    """`G` at this eps and at eps = 0, and the slopes that the contact allows."""
    waves = waves_of_numbers(numbers)
    potential = with_profile(scene, waves).potential
    grid = jnp.arange(waves.points) / waves.points
    stretch = jax.vmap(lambda y: potential.tip_force(y, eps)[1])(grid)
    heights, slopes = jax.vmap(jax.value_and_grad(waves))(grid)
    inside = (slopes > limits.lower) & (slopes < limits.upper)
    inside &= jnp.abs(heights) <= limits.height
    least = jnp.minimum(stretch, 1 + potential.a() * slopes)
    return jnp.all((least > SETTINGS.stretch) & inside)


@Program
def _tips(numbers: Array, scene: Scene, eps: Any, z: Array) -> Array:
    potential = with_profile(scene, waves_of_numbers(numbers)).potential
    return jax.vmap(lambda s: potential.tip(s, eps)[1])(z)


@Program
def _states(support: AbstractSupport, forces: Array) -> Array:
    return jax.vmap(support.state_of)(forces)


def states_under(scene: Scene, forces: np.ndarray) -> np.ndarray:
    """States in m at which the support has these forces in N."""
    return in_chunks(_states, SETTINGS.together, (scene.support,), (forces,))


@Program
def _fastest(load: AbstractPull, support: AbstractSupport, duration: Array) -> Array:
    """Largest |l'|/Phi'' without wiggles, m/s."""
    ts = duration * (jnp.arange(SETTINGS.times) + 0.5) / SETTINGS.times
    states = jax.vmap(lambda t: support.state_of(load(t)))(ts)
    speeds = jax.vmap(load.slope)(ts) / jax.vmap(support.stiffness_at)(states)
    return jnp.max(jnp.abs(speeds))


def in_tables(scene: Scene, eps: float, harmonics: int) -> tuple[Scene, SurfaceLimits]:
    """The scene with a bristle that is exact on all surfaces that are tried.

    Between two slopes a surface of mean 0 is no higher than one that rises all along at one
    and falls at the other.
    """
    assert isinstance(scene.bristle, AbstractBristle)
    bounds = scene.bristle.slope_bounds()
    inverse = 1 / float(bounds.upper) - 1 / float(bounds.lower)
    height = min(0.5 / inverse, SETTINGS.highest) if inverse > 0 else SETTINGS.highest
    bristle = in_one_size(bristle_series(scene.bristle, eps * height))
    if not isinstance(bristle, SeriesBristle):
        height = np.inf
    flat = waves_of_numbers(jnp.zeros(2 * harmonics))
    limits = SurfaceLimits(*map(np.asarray, (bounds.lower, bounds.upper, height)))
    return scene_on_edges(scene, BristlePotential(flat, bristle)), limits


def trace_problem(
    trace: Trace, scene: Any, eps: float, gamma: float, harmonics: int, accuracy: Any
) -> TraceProblem:
    """Check the arguments of `fit_trace` that belong together."""
    given = isinstance(scene, Scene) and isinstance(scene.potential, BristlePotential)
    require(given, "scene", kind_of(scene), "a Scene with a profile and a bristle")
    ts = np.asarray(require_times(scene, trace.ts))
    alpha = abs(float(scene.potential.alpha()))
    scene, limits = in_tables(scene, eps, harmonics)
    z, wanted = trace.values, None
    if trace.quantity == "force":
        wanted = pulls_at(scene, ts, np.zeros_like(ts)).load - trace.values
        z = states_under(scene, wanted)
    load, force, stiffness = pulls_at(scene, ts, z)
    if wanted is not None:
        known = np.allclose(force, wanted, rtol=1e-9, atol=1e-9 * np.max(np.abs(wanted)))
        allowed = "forces that the support can have: no z with Phi'(z) = l - force"
        require(known, "trace.force", trace.values, allowed)
    sliding = float(_fastest(scene.load, scene.support, scene.duration))
    require(sliding > 0, "scene.load", "constant", "a load that moves")
    sd = np.full(ts.size, accuracy * eps)
    if trace.uncertainty is not None:
        own = trace.uncertainty / (stiffness if trace.quantity == "force" else 1.0)
        sd = np.hypot(sd, own)
    rest = load - force
    half = max(0.5 * float(np.ptp(np.percentile(rest, [2, 98]))), alpha * SETTINGS.no_force)
    reading = read(ts, z, sd, rest, eps**gamma, stiffness)
    drag_sd = np.hypot(reading.drag_sd, SETTINGS.start_rough * half)
    turns = np.tile((2 * np.pi * np.arange(1, harmonics + 1)) ** 4, 2)
    bending = 0.5 * (2 * np.pi * half / alpha) ** 2
    more = padded_size(ts.size, SETTINGS.room_of_times) - ts.size
    padded = np.pad(ts, (0, more), mode="edge")
    numbers = np.asarray(eps), np.asarray(gamma), np.asarray(as_real(accuracy))
    rough = reading._replace(drag_sd=drag_sd)
    penalty = 0.5 * turns / (SETTINGS.bent * bending)
    passages = passages_of(scene, ts, z, sd, eps)
    found: Any = padded, reading, rough, sliding, penalty, passages, half
    return TraceProblem(scene, limits, *numbers, *found)
