"""Plans of cells that were asked what they will cost, kept for the sweep that follows.

`frictionjax study` says what a sweep will cost before it runs: both go by one plan.
"""

import numpy as np

from .._checks import ByIdentity
from ..model import Scene, TabulatedScene
from .limit_path import Path
from .plan import Planned, planned

_AHEAD = ByIdentity()  # the last plan that was made ahead for a scene, and what it is of


def plan_of_cells(
    scene: Scene,
    tables: TabulatedScene,
    path: Path,
    eps: np.ndarray,
    gamma: np.ndarray,
    times: int,
    accuracy: float,
    method: str,
    ahead: bool = False,
) -> Planned:
    """The plan of cells: that made ahead, or a new one; kept, once, where it is `ahead`."""
    asked = _asked(eps, gamma, times, accuracy, method)
    known = _AHEAD.take(scene)
    if known is not None and known[0] == asked:
        plan = known[1]
    else:
        plan = planned(tables, path, eps, gamma, times, accuracy, method)
    if ahead:
        _AHEAD.put(scene, (asked, plan))
    return plan


def _asked(
    eps: np.ndarray, gamma: np.ndarray, times: int, accuracy: float, method: str
) -> tuple:
    """What a scene's plan is of."""
    cells = np.asarray(eps, dtype=float), np.asarray(gamma, dtype=float)
    return *(values.tobytes() for values in cells), int(times), float(accuracy), method
