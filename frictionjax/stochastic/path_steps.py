"""How long a step of a path is, and how many there are."""

from typing import NamedTuple

import numpy as np

from .._checks import require
from .force_table import TabulatedForce
from .settings import SETTINGS


class PathSteps(NamedTuple):
    """`total` steps of `step` s, the last of which ends with the scene."""

    step: float
    total: int


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

    Raises `ValueError` naming eps where steps are more than 2^31.
    """
    curvature = stiffness + max(force.curvature, 0.0)
    by_curvature = SETTINGS.step_curvature * viscosity / curvature
    by_diffusion = 0.5 * viscosity * (SETTINGS.step_diffusion * eps) ** 2 / temperature
    steps = np.ceil(duration / min(by_curvature, by_diffusion))
    few = steps <= SETTINGS.most_steps
    allowed = f"at most {SETTINGS.most_steps} steps of a path, here {steps:.3g}"
    require(few, "eps", eps, allowed)
    total = max(1, int(steps))
    return PathSteps(duration / total, total)
