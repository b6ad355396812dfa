"""Plans of cells that were asked what they will cost, kept for the sweep that follows.

`frictionjax study` says what a sweep will cost before it runs: both go by one plan.
"""

import numpy as np

from .._checks import ByIdentity
from ..model import Scene
from .lanes import LaneScene
from .limit_path import Path
from .plan import Planned, planned

_AHEAD = ByIdentity()  # the last plan that was made ahead for a scene, and what it is of


def plan_ahead(
    scene: Scene,
    lanes: LaneScene,
    path: Path,
    eps: np.ndarray,
    gamma: np.ndarray,
    times: int,
    accuracy: float,
    method: str,
) -> Planned:
    """The plan of cells, which `plan_of_cells` need not make again."""
    plan = planned(scene, lanes, path, eps, gamma, times, accuracy, method)
    _AHEAD.put(scene, (_asked(eps, gamma, times, accuracy, method), plan))
    return plan


def plan_of_cells(
    scene: Scene,
    lanes: LaneScene,
    path: Path,
    eps: np.ndarray,
    gamma: np.ndarray,
    times: int,
    accuracy: float,
    method: str,
) -> Planned:
    """The plan of cells: that made ahead, once, or a new one."""
    ahead = _AHEAD.take(scene)
    if ahead is not None and ahead[0] == _asked(eps, gamma, times, accuracy, method):
        return ahead[1]
    return planned(scene, lanes, path, eps, gamma, times, accuracy, method)


def _asked(
    eps: np.ndarray, gamma: np.ndarray, times: int, accuracy: float, method: str
) -> tuple:
    """What a scene's plan is of."""
    cells = np.asarray(eps, dtype=float), np.asarray(gamma, dtype=float)
    return *(values.tobytes() for values in cells), int(times), float(accuracy), method
