"""What an effect costs: steps with it over steps without, by the rules of its scheme."""

import numpy as np

from ..called_for import Setting, inertia_numbers
from ..effects import AbstractEffect, Inertia, Noise, Stage
from ..limit import solve_limit
from ..model import Scene
from ..wiggly import workload

# Steps of all runs of a tip with mass, a well of the limit's way, at an accuracy of 1e-3:
# 107, 167 and 264 were seen at 1e-2, 1e-3 and 1e-4 (the order of the scheme is 5), and at
# 1e-3 from 160 to 350 where beta < 1 (`tests/explain/test_costs.py`).
_STEPS_A_WELL = 200.0
_BY_ACCURACY = 0.2
# Heavier tips slip through wells without a stop: 151, 61, 47 at beta = 31, 63, 630.
_HEAVY, _BY_BETA = 10.0, 0.3
_MOMENTS = 2001  # of the limit, that tell its way
_TIMES = 201  # that are asked for where none are


def steps_ratio(
    effect: AbstractEffect, scene: Scene, at: Setting, accuracy: float
) -> float:
    """Of an effect that changes what moves; NaN where nothing says.

    A step of a path with noise is shorter than one of a lane, about a tenth in time.
    """
    if not isinstance(effect, Noise | Inertia):
        return np.nan
    plain = scene.replace(effects=_of_potential(scene))
    cell = np.array([at.eps]), np.array([at.gamma])
    work = workload(plain, *cell, _TIMES, accuracy, "auto")
    if work is None:
        return np.nan
    if isinstance(effect, Noise):
        return _steps_of_path(effect, scene, at) / float(work.steps[0])
    return _steps_with_mass(effect, plain, at, accuracy) / float(work.steps[0])


def _of_potential(scene: Scene) -> tuple[AbstractEffect, ...]:
    return tuple(e for e in scene.effects if e.stage == Stage.POTENTIAL)


def _steps_of_path(noise: Noise, scene: Scene, at: Setting) -> float:
    """Those that it takes: infinite where they are too many."""
    from ..stochastic import TooManyStepsError, steps_of_path  # nothing else needs it

    try:
        return float(steps_of_path(scene, noise, eps=at.eps, gamma=at.gamma))
    except TooManyStepsError:
        return np.inf


def _steps_with_mass(inertia: Inertia, plain: Scene, at: Setting, accuracy: float) -> float:
    """By the way of the limit."""
    ts = np.linspace(0.0, float(plain.duration), _MOMENTS)
    wells = float(np.sum(np.abs(np.diff(np.asarray(solve_limit(plain, ts).z))))) / at.eps
    beta = float(inertia_numbers(at.scene.potential, inertia, at.eps, at.gamma))
    heavy = min(1.0, (_HEAVY / beta) ** _BY_BETA)
    finer = (1e-3 / accuracy) ** _BY_ACCURACY
    return max(1.0, _STEPS_A_WELL * wells * finer * heavy)
