"""How runs of `work_precision` are drawn: looks of methods, runs that are not done."""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from ..wiggly import ENDED, Status, is_ours
from .style import LIMIT, colour, marker

MOST = 1e3  # eps: further off is as wrong
TOO_LITTLE = "#fbe9e1"  # behind accuracies that are not kept
UNKNOWN = "#eeeeee"  # behind errors that the reference cannot judge
NOT_DONE: dict[str, Any] = {"marker": "^", "linestyle": "none", "markersize": 5}
WRONG: dict[str, Any] = {"marker": "x", "linestyle": "none", "color": LIMIT}
WRONG |= {"markersize": 9, "markeredgewidth": 1.6, "zorder": 5}
_EDGE: dict[str, Any] = {"markeredgecolor": "white", "markeredgewidth": 0.7}
_LEAST = 1e-10  # eps: two references that agree to the last digit are not better
_STRIP = 0.1  # of the height of a panel: for runs that are not done
_SPREAD, _STEP = 0.5, 0.1  # of the distance of two places: for all methods, between two
_SIZES = {"auto": 12.0, "resolved": 9.0, "windowed": 6.0}


class DrawnRuns(NamedTuple):
    """Runs of one method along one dimension, arrays of one shape.

    `errors` in eps, at most 1000 and at least what the reference can judge; `drawn`: the
    run has an error; `failed`: it did not come to its end. `spread` (2, n): seconds of the
    fastest and the slowest run.
    """

    seconds: np.ndarray
    spread: np.ndarray
    errors: np.ndarray
    drawn: np.ndarray
    wrong: np.ndarray
    failed: np.ndarray


def runs_of(line: xr.Dataset) -> DrawnRuns:
    """The runs in a data set of one dimension."""
    errors = np.clip(line.error.values, floor_of(line), MOST)
    failed = failed_runs(line)
    drawn = ~failed & np.isfinite(errors)
    spread = np.stack([line.seconds_low.values, line.seconds_high.values])
    wrong = line.wrong.values > 0
    return DrawnRuns(line.seconds.values, spread, errors, drawn, wrong, failed)


def failed_runs(runs: xr.Dataset) -> np.ndarray:
    """Which runs did not come to their end, whatever their errors are."""
    return ~np.isin(runs.status.values, ENDED)


def untried_runs(runs: xr.Dataset) -> np.ndarray:
    """Which of these were not begun: too slow before, or no time was left."""
    return runs.status.values == int(Status.NOT_TRIED)


def floor_of(cells: xr.Dataset) -> np.ndarray:
    """Errors of references in eps, as they are drawn; that of none is the largest."""
    known = np.asarray(cells.reference_error.values, dtype=float)
    return np.where(np.isfinite(known), np.clip(known, _LEAST, MOST), MOST)


def look(name: str, index: int) -> dict[str, Any]:
    """The library's own methods filled, of three sizes; general solvers open.

    Where own methods do the same, all are seen, one inside the other.
    """
    shade = colour(index)
    common = {"color": shade, "marker": marker(index), "zorder": 3}
    if is_ours(name):
        size = _SIZES[name]
        own = {"markersize": size, "zorder": 5 - 0.1 * size}  # smaller ones on top
        return common | own | {"linewidth": 2.4, **_EDGE}
    return common | {"markerfacecolor": "white", "markersize": 6, "linewidth": 1.2}


def apart(values: np.ndarray, count: int, scale: str = "log") -> list[np.ndarray]:
    """For each of `count` methods the places, moved to the side on such an axis."""
    places, back, room = _room(values, scale)
    steps = min(_STEP, _SPREAD / count) * (np.arange(count) - 0.5 * (count - 1))
    return [back(places + room * step) for step in steps]


def beside_each_other(dataset: xr.Dataset) -> str:
    """For the label of an axis on which methods have been moved `apart`."""
    return ", methods side by side" if dataset.solver.size > 1 else ""


def set_places(axes: Any, values: np.ndarray, scale: str = "log") -> None:
    """An x axis with as much room beside the outer places as between the nearest."""
    places, back, room = _room(values, scale)
    ends = back(places.min() - 0.5 * room), back(places.max() + 0.5 * room)
    axes.set(xscale=scale, xlim=ends)


def _room(values: np.ndarray, scale: str) -> tuple[np.ndarray, Any, float]:
    """Places along the axis, the way back to values, and the least distance, at most 1."""
    there, back = (np.log10, lambda v: 10**v) if scale == "log" else (np.array, np.array)
    places = there(values)
    known = np.unique(places)
    return places, back, float(np.diff(known).min(initial=1.0))


def mark_failed(
    panels: list[Any], failed: list[list[np.ndarray]], levels: bool = False
) -> None:
    """Places of runs that are not done along the upper edge, for each panel and method.

    The panels of a row get the same limits. `levels`: one for each method, where places
    may be the same. To be called last: above the line y has no meaning.
    """
    if not any(places.size for methods in failed for places in methods):
        return
    low, high = panels[0].get_ylim()
    ticks = [_between(panels[0].get_yticks(minor=m), low, high) for m in (False, True)]
    top = high * (high / low) ** (_STRIP / (1 - _STRIP))
    for axes, methods in zip(panels, failed, strict=True):
        axes.set_yticks(ticks[0])
        axes.set_yticks(ticks[1], minor=True)
        axes.set_ylim(low, top)
        axes.axhspan(high, top, color="white", zorder=2.5)
        axes.axhline(high, color=LIMIT, linewidth=0.8, zorder=2.6)
        along_edge = {"transform": axes.get_xaxis_transform(), "zorder": 5}
        for index, places in enumerate(methods):
            level = index / max(1, len(methods) - 1) if levels else 0.5
            height = np.full(places.size, 1 - (0.2 + 0.6 * level) * _STRIP)
            axes.plot(places, height, color=colour(index), **NOT_DONE, **along_edge)
    where = {"xycoords": "axes fraction", "annotation_clip": False}
    text = {"ha": "right", "va": "center", "color": LIMIT, "fontsize": 8}
    panels[0].annotate("not\ndone", (-0.015, 1 - 0.5 * _STRIP), **where, **text)


def _between(ticks: np.ndarray, low: float, high: float) -> list[float]:
    """Ticks of which none is so high that its label is in the way of "not done"."""
    return [float(tick) for tick in ticks if low <= tick < low * (high / low) ** 0.97]
