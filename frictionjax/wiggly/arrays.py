"""Many bristles on one root, each with its own support: all of them as cells, in means."""

from typing import Any

import numpy as np

from ..effects import CompliantArray
from ..model import Scene
from .batch import integrate_cells
from .equation import Status
from .settings import SETTINGS
from .sums import CellResults


def integrate_scene(scene: Scene, eps: np.ndarray, gamma: np.ndarray, **asked: Any) -> Any:
    """As `integrate_cells`, and how far bristles of an array are apart, (cells, n) in m.

    Of an array cells are means over its bristles; else there is nothing apart, None.
    """
    arrays = [e for e in scene.effects if isinstance(e, CompliantArray)]
    if not arrays:
        return integrate_cells(scene=scene, eps=eps, gamma=gamma, **asked), None
    offsets = np.asarray(arrays[0].offsets)
    report = asked.pop("report", lambda share: None)
    parts = []
    for start in range(0, offsets.size, SETTINGS.bristles):
        some = offsets[start : start + SETTINGS.bristles]
        parts.append(
            integrate_cells(
                scene=scene,
                eps=np.repeat(eps, some.size),
                gamma=np.repeat(gamma, some.size),
                phase=np.tile(some, eps.size),
                report=_shared(report, some.size / offsets.size),
                **asked,
            )
        )
    if any(part is None for part in parts):
        return None, None
    cells = [_by_cell(part, eps.size) for part in parts]
    every = CellResults(*(np.concatenate(c, axis=1) for c in zip(*cells, strict=True)))
    return _means(every), np.std(every.z, axis=1)


def _shared(report: Any, share: float) -> Any:
    return lambda done: report(share * done)


def _by_cell(part: CellResults, cells: int) -> CellResults:
    """Columns (cells, bristles, ...) of columns (cells * bristles, ...)."""
    return CellResults(*(c.reshape(cells, -1, *c.shape[1:]) for c in part))


def _means(every: CellResults) -> CellResults:
    """Means over bristles, sums of what they took, and of checks the worst of them.

    Of suprema too: that of a mean is no larger than the mean of suprema.
    """
    means = {name: np.mean(column, axis=1) for name, column in every._asdict().items()}
    for name in ("how", "gap", "survey_error", "survey_work_error", "strip_excess"):
        means[name] = np.max(getattr(every, name), axis=1)
    for name in ("steps", "rejected"):
        means[name] = np.sum(getattr(every, name), axis=1)
    failed = every.status != int(Status.OK)
    first = np.argmax(failed, axis=1)
    means["status"] = every.status[np.arange(first.size), first]
    return CellResults(**means)
