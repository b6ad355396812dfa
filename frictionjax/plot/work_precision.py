"""What accuracy costs in time: error against time, asked against reached."""

from itertools import cycle
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from .style import (
    GUIDE,
    LIMIT,
    choose_eps,
    choose_gamma,
    colour,
    marker,
    new_figure,
    styled,
)

_MOST = 1e3  # eps: further off is as wrong
_MIDDLE = {"xycoords": "axes fraction", "ha": "center", "color": "#666666"}
_LINES = ("-", "--", ":", "-.")
_KEY = (
    "grey band: Pareto front; crosses: success reported, but in another well; "
    "errors beyond 1000 eps are drawn there;\n"
    "shaded below: less than the error of the reference, where nothing is concluded"
)


@styled
def draw(
    dataset: xr.Dataset, eps: float | None = None, gamma: float | None = None
) -> Figure:
    """Draw a data set of `work_precision`.

    Left: error against seconds in one cell, one line a method, the Pareto front as a
    band; right: accuracy reached against accuracy asked for. The cell: the smallest eps
    and gamma = 1 where none is named. With more than one eps, below: seconds, and error
    over accuracy, against eps, one line style a gamma, at the accuracy in the middle.

    Raises `ValueError` for an eps or gamma that the data set does not hold.
    """
    gamma = choose_gamma(dataset, gamma)
    smallest = float(dataset.eps.min())
    chosen = smallest if eps is None else float(choose_eps(dataset, gamma, eps)[0])
    cell = dataset.sel(gamma=gamma, eps=chosen)
    rows = 2 if dataset.eps.size > 1 else 1
    figure, grid = new_figure(rows, 2, 11.0, 4.9 * rows)
    _times(grid[0, 0], cell)
    _calibration(grid[0, 1], cell)
    if rows == 2:
        _over_eps(grid[1], dataset)
    figure.supxlabel(_KEY, fontsize=9, color="#666666")
    return figure


def _look(index: int) -> dict[str, Any]:
    """Later lines are smaller: where two methods do the same, both are seen."""
    size = max(4.0, 9.0 - 1.5 * index)
    return {"color": colour(index), "marker": marker(index), "markersize": size}


def _known(line: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Seconds, errors and which are in another well, of the runs that ended."""
    good = np.isfinite(line.error.values) & (line.error.values > 0)
    errors = np.minimum(line.error.values[good], _MOST)
    return line.seconds.values[good], errors, line.wrong.values[good] > 0


def _times(axes: Any, cell: xr.Dataset) -> None:
    points = []
    for index, name in enumerate(cell.solver.values):
        line = cell.sel(solver=name)
        seconds, errors, wrong = _known(line)
        axes.plot(seconds, errors, **_look(index), label=_label(line, seconds))
        axes.plot(seconds[wrong], errors[wrong], "x", color=LIMIT, markersize=10)
        # Of those below the reference's error none is known to be better.
        points.append(np.stack([seconds, np.maximum(errors, _floor_of(cell))]))
    front = _front(np.concatenate(points, axis=1))
    if front.size:
        look = {"linewidth": 9, "alpha": 0.35, "color": GUIDE, "zorder": 1}
        axes.plot(*front, solid_capstyle="round", **look)
    axes.set(xscale="log", yscale="log", xlabel="seconds of a warm run")
    axes.set(ylabel="largest error of z outside slips ($\\epsilon$)")
    axes.set_title(f"$\\epsilon$ = {float(cell.eps):.3g} m, $\\gamma$ = {cell.gamma:.3g}")
    _floor(axes, _floor_of(cell))
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)


def _label(line: xr.Dataset, seconds: np.ndarray) -> str:
    failed = line.accuracy.size - seconds.size
    name = str(line.solver.item())
    return f"{name} ({failed} of {line.accuracy.size} not done)" if failed else name


def _front(points: np.ndarray) -> np.ndarray:
    """Points that no other beats in both, in the order of their times."""
    order = np.lexsort(points[::-1])
    ordered = points[:, order]
    best = np.minimum.accumulate(ordered[1])
    better = np.ones(order.size, dtype=bool)
    better[1:] = ordered[1, 1:] < best[:-1]
    return ordered[:, better]


def _floor_of(cell: xr.Dataset) -> float:
    """Error of the reference, as it is drawn; that of none is the largest."""
    error = float(cell.reference_error)
    return min(error, _MOST) if np.isfinite(error) else _MOST


def _floor(axes: Any, error: float) -> None:
    """Below the reference's own error nothing is known."""
    low, high = axes.get_ylim()
    if low <= 0:  # nothing is drawn
        low, high = 1 / _MOST, _MOST
        axes.set_ylim(low, high)
    if error > low:
        axes.axhspan(low, min(error, high), color="#eeeeee", zorder=0)
        axes.set_ylim(low, high)
    if error >= _MOST:
        axes.annotate("no reference to judge by", (0.5, 0.5), **_MIDDLE)


def _calibration(axes: Any, cell: xr.Dataset) -> None:
    asked = cell.accuracy.values
    for index, name in enumerate(cell.solver.values):
        errors = np.minimum(cell.sel(solver=name).error.values, _MOST)
        axes.plot(asked, errors, **_look(index))
    ends = np.array([asked.min() / 2, asked.max() * 2])
    axes.plot(ends, ends, color=LIMIT, linewidth=1)
    axes.set(xscale="log", yscale="log", xlim=ends, ylabel="error reached ($\\epsilon$)")
    _floor(axes, _floor_of(cell))
    low, high = axes.get_ylim()
    axes.fill_between(ends, ends, high, color="#fbe9e1", zorder=0)
    axes.set_ylim(low, high)
    axes.set_xlabel("accuracy asked for ($\\epsilon$)")
    axes.set_title("Reached against asked for: above the line is too little")


def _over_eps(row: Any, dataset: xr.Dataset) -> None:
    middle = dataset.isel(accuracy=dataset.accuracy.size // 2)
    asked = float(middle.accuracy)
    for index, name in enumerate(dataset.solver.values):
        for gamma, style in zip(dataset.gamma.values, cycle(_LINES)):
            line = middle.sel(solver=name, gamma=gamma)
            look = _look(index) | {"linestyle": style}
            good = np.isfinite(line.error.values)
            eps, error = line.eps.values[good], np.minimum(line.error.values[good], _MOST)
            row[0].plot(eps, line.seconds.values[good], **look)
            row[1].plot(eps, error / asked, **look)
    for gamma, style in zip(dataset.gamma.values, cycle(_LINES)):
        row[0].plot([], [], style, color=LIMIT, label=f"$\\gamma$ = {gamma:.3g}")
    row[0].set(ylabel="seconds of a warm run", title=f"Time at accuracy {asked:.0e}")
    row[1].set(ylabel="error reached over asked for", title="Is the accuracy kept?")
    row[1].axhline(1.0, color=LIMIT, linewidth=1)
    row[0].legend()
    for axes in row:
        axes.set(xscale="log", yscale="log", xlabel="$\\epsilon$ (m)")
