"""Where the fit of a trace starts: the equation itself, read at the samples."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from ..._compile import Program, in_chunks
from ...model import Scene
from .flow import waves_of_numbers, with_profile
from .settings import SETTINGS


class Reading(NamedTuple):
    """What samples say of the wiggle force: arrays (n,).

    `z` in m, `sd` of it; `force`: `l - Phi' - eps^gamma z'` in N, the derivative by
    differences; `drag_sd`: error of that in N; `support`: Phi'' in N/m.
    """

    z: np.ndarray
    sd: np.ndarray
    force: np.ndarray
    drag_sd: np.ndarray
    support: np.ndarray


def read(ts: np.ndarray, z: np.ndarray, sd: np.ndarray, rest: np.ndarray, drag, support):
    """Read the equation `V_eps'(z) = l - Phi'(z) - eps^gamma z'` (eq. 2.8) at samples.

    `rest`: `l - Phi'(z)`, N. The speed by central differences; half the difference of the
    one before and the one after is taken for its error, so that samples in slips, and
    slips between samples, count little where viscosity matters.
    """
    width = np.diff(ts)
    slopes = np.diff(z) / width
    before, after = np.append(slopes[:1], slopes), np.append(slopes, slopes[-1:])
    spacing = np.append(width[:1], width) + np.append(width, width[-1:])
    noise = sd * np.sqrt(2.0) / spacing
    error = np.hypot(0.5 * (after - before), noise)
    return Reading(z, sd, rest - 0.5 * drag * (before + after), drag * error, support)


@Program
def _wiggle(
    numbers: Array, scene: Scene, eps: Any, states: Array
) -> tuple[Array, Array, Array]:

    def one(numbers: Array, z: Array) -> Array:
        potential = with_profile(scene, waves_of_numbers(numbers)).potential
        return potential.tip_force(potential.tip(z, eps)[1], eps)[0]

    def at(z: Array) -> tuple[Array, Array, Array]:
        force, stiffness = jax.jvp(lambda s: one(numbers, s), (z,), (jnp.ones_like(z),))
        return force, stiffness, jax.jacfwd(one)(numbers, z)

    return jax.vmap(at)(states)


def wiggle(
    numbers: np.ndarray, scene: Scene, eps: Any, states: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """`V_eps'` in N, `V_eps''` in N/m at states (n,), and the first by the numbers."""
    return in_chunks(_wiggle, SETTINGS.together, (numbers, scene, eps), (states,))


class Read(NamedTuple):
    """The equation at samples: `r` in N, (n,), its derivative `by`, (n, unknowns).

    `steep`: what an error of z costs, `|V''| + Phi''` in N/m: it moves samples along the
    curve. `drag_sd`: error of the rest, N.
    """

    r: np.ndarray
    by: np.ndarray
    steep: np.ndarray
    drag_sd: np.ndarray

    def deviation(self, sd: np.ndarray) -> np.ndarray:
        """Of `r`, N, where that of z is `sd`, m."""
        return np.hypot(sd * self.steep, self.drag_sd)


def read_residuals(reading: Reading, scene: Any, eps: Any, numbers: np.ndarray) -> Read:
    """The wiggle force of the surface at the measured states, less what was read."""
    force, stiffness, by = wiggle(numbers, scene, eps, reading.z)
    steep = np.abs(stiffness) + reading.support
    return Read(force - reading.force, by, steep, reading.drag_sd)


def start_numbers(
    reading: Reading, scene: Any, eps: Any, numbers, penalty, admissible, held
):
    """Coefficients that fit the wiggle force at the samples, by Gauss-Newton.

    `penalty`: of each squared coefficient. `admissible(numbers)`: whether the bristle can
    follow. `held(numbers)`: excess over bounds and its derivative, in deviations. Samples
    off the curve (in slips) count little: weights `1/(1 + (r/3s)^2)`, s the median.
    """
    for _ in range(SETTINGS.rounds):
        found = read_residuals(reading, scene, eps, numbers)
        over, over_by = held(numbers)
        sd = found.deviation(reading.sd)
        r, rows = found.r / sd, found.by / sd[:, None]
        scale = max(1.0, 1.5 * float(np.median(np.abs(r))))
        weight = 1 / (1 + (r / (SETTINGS.half_at * scale)) ** 2)
        normal = (
            (rows.T * weight) @ rows / scale**2 + np.diag(penalty) + over_by.T @ over_by
        )
        slope = rows.T @ (weight * r) / scale**2 + penalty * numbers + over_by.T @ over
        step = -np.linalg.solve(normal, slope)
        while not admissible(numbers + step):
            step = 0.5 * step
        numbers = numbers + step
        if np.linalg.norm(step) <= SETTINGS.settled * np.linalg.norm(numbers):
            break
    return numbers
