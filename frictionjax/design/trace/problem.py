"""A fit to a trace, checked: samples as states, and programs of the coefficients."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from ..._checks import as_real, require
from ..._compile import Program, padded_size
from ...model import BristlePotential, Scene, require_times
from ..measured_trace import Trace, forces_at
from .flow import Flow, bumped_flow, flow, plan_of, waves_of_numbers, with_profile
from .gauss_newton import TraceSamples
from .passed import Passages, held, passages_of
from .settings import SETTINGS
from .start import Read, Reading, read, read_residuals
from .weights import bumps_of


class TraceProblem(NamedTuple):
    """A checked fit: trace as states, and programs of the coefficients."""

    scene: Scene
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

    def held(self, numbers: np.ndarray, rough: float | None = None):
        """Excess over what passages allow, and its derivative, in `rough` of the forces."""
        rough = SETTINGS.start_rough if rough is None else rough
        found = held(self.passages, self.scene, self.eps, numbers)
        return found.r / (rough * self.half), found.by / (rough * self.half)

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
        found = np.asarray(_tips(numbers, self.scene, self.eps, z))
        return found - np.floor(found)

    def unheld(self) -> np.ndarray:
        """States under the load alone, without friction."""
        load = np.asarray(forces_at(self.scene, self.ts, np.zeros_like(self.ts))[0])
        return np.asarray(states_under(self.scene, load))

    def quantity_of(self, quantity: str, z: np.ndarray) -> np.ndarray:
        """What the trace measures, at states z."""
        if quantity == "z":
            return z
        load, force, _ = forces_at(self.scene, self.ts[: z.size], z)
        return np.asarray(load) - np.asarray(force)

    def admissible(self, numbers: np.ndarray) -> bool:
        """Whether the bristle follows the surface, with a margin."""
        return bool(_follows(numbers, self.scene, self.eps))

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
def _follows(numbers: Array, scene: Scene, eps: Any) -> Array:
    """`G` at this eps and at eps = 0, and the slopes that the contact allows."""
    waves = waves_of_numbers(numbers)
    potential = with_profile(scene, waves).potential
    grid = jnp.arange(waves.points) / waves.points
    stretch = jax.vmap(lambda y: potential.tip_force(y, eps)[1])(grid)
    slopes = jax.vmap(jax.grad(waves))(grid)
    ends = potential.bristle.slope_bounds()
    inside = (slopes > ends.lower) & (slopes < ends.upper)
    least = jnp.minimum(stretch, 1 + potential.a() * slopes)
    return jnp.all((least > SETTINGS.stretch) & inside)


@Program
def _tips(numbers: Array, scene: Scene, eps: Any, z: Array) -> Array:
    potential = with_profile(scene, waves_of_numbers(numbers)).potential
    return jax.vmap(lambda s: potential.tip(s, eps)[1])(z)


@Program
def states_under(scene: Scene, forces: Any) -> Array:
    """States at which the support has these forces."""
    return jax.vmap(scene.support.state_of)(forces)


@Program
def _fastest(scene: Scene) -> Array:
    """Largest |l'|/Phi'' without wiggles, m/s."""
    ts = scene.duration * (jnp.arange(SETTINGS.times) + 0.5) / SETTINGS.times
    states = jax.vmap(lambda t: scene.support.state_of(scene.load(t)))(ts)
    speeds = jax.vmap(scene.load.slope)(ts) / jax.vmap(scene.support.stiffness_at)(states)
    return jnp.max(jnp.abs(speeds))


def trace_problem(
    trace: Trace, scene: Any, eps: float, gamma: float, harmonics: int, accuracy: Any
) -> TraceProblem:
    """Check the arguments of `fit_trace` that belong together."""
    given = isinstance(scene, Scene) and isinstance(scene.potential, BristlePotential)
    require(given, "scene", type(scene).__name__, "a Scene with a profile and a bristle")
    times = require_times(scene, trace.ts)
    ts = np.asarray(times)
    z, wanted = trace.values, None
    if trace.quantity == "force":
        load = np.asarray(forces_at(scene, ts, np.zeros_like(ts))[0])
        wanted = load - trace.values
        z = np.asarray(states_under(scene, wanted))
    load, force, stiffness = (np.asarray(v) for v in forces_at(scene, ts, z))
    if wanted is not None:
        known = np.allclose(force, wanted, rtol=1e-9, atol=1e-9 * np.max(np.abs(wanted)))
        allowed = "forces that the support can have: no z with Phi'(z) = l - force"
        require(known, "trace.force", trace.values, allowed)
    sliding = float(_fastest(scene))
    require(sliding > 0, "scene.load", "constant", "a load that moves")
    sd = np.full(ts.size, accuracy * eps)
    if trace.uncertainty is not None:
        own = trace.uncertainty / (stiffness if trace.quantity == "force" else 1.0)
        sd = np.hypot(sd, own)
    rest = load - force
    alpha = abs(float(scene.potential.alpha()))
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
    return TraceProblem(scene, *numbers, *found)
