"""How long a step of a path is, and how many there are."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from .._checks import as_text
from .force_table import TabulatedForce
from .settings import SETTINGS


class TooManyStepsError(ValueError):
    """A path that would take more steps than are counted."""


class PathSteps(NamedTuple):
    """`total` steps of `step` s, the last of which ends with the scene."""

    step: float
    total: int

    def nearest(self, ts: Float[np.ndarray, " times"]) -> Int[np.ndarray, " times"]:
        """Numbers of the steps nearest to times in s: how many were taken until then."""
        return np.minimum(np.rint(ts / self.step).astype(int), self.total)


def steps_of_paths(
    force: TabulatedForce,
    stiffness: float,
    *,
    eps: float,
    viscosity: float,
    temperature: float,
    duration: float,
) -> PathSteps:
    """By the largest curvature of the energy, and by how far free diffusion goes.

    `stiffness`: largest Phi'' in N/m; the rest as `Bath` has it. Below
    step times curvature over viscosity = 1, one step keeps the order of states under the
    same noise, so that two paths of one key that start apart close in on every other.

    Raises `TooManyStepsError`, a `ValueError` naming eps, where steps are more than 2^31.
    """
    curvature = stiffness + max(force.curvature, 0.0)
    by_curvature = SETTINGS.step_curvature * viscosity / curvature
    by_diffusion = 0.5 * viscosity * (SETTINGS.step_diffusion * eps) ** 2 / temperature
    step = min(by_curvature, by_diffusion)
    # A support may be so stiff somewhere that floats do not hold it.
    steps = np.ceil(duration / step) if step > 0 else np.inf
    if not steps <= SETTINGS.most_steps:
        allowed = f"at most {SETTINGS.most_steps} steps of a path, here {steps:.3g}"
        raise TooManyStepsError(f"eps = {as_text(eps)}: needs {allowed}")
    total = max(1, int(steps))
    return PathSteps(duration / total, total)
