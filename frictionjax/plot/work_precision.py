"""What accuracy costs in time: error against time, asked against reached."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullFormatter

from .cost_cells import columns_below, draw_cells
from .cost_runs import (
    MOST,
    NOT_DONE,
    TOO_LITTLE,
    UNKNOWN,
    WRONG,
    DrawnRuns,
    apart,
    beside_each_other,
    failed_runs,
    floor_of,
    look,
    mark_failed,
    runs_of,
    set_places,
    untried_runs,
)
from .style import LIMIT, Picture, choose_eps, choose_gamma, styled

_MIDDLE = {"xycoords": "axes fraction", "ha": "center", "color": "#666666"}
_FRONT: dict[str, Any] = {"color": "#F0E442", "alpha": 0.75, "linewidth": 12}
_FRONT |= {"marker": "o", "markersize": 20, "markeredgewidth": 0}
_SPREAD: dict[str, Any] = {"linewidth": 1, "alpha": 0.6, "zorder": 2}
_CAP: dict[str, Any] = {"color": LIMIT, "linestyle": ":", "linewidth": 1}
_SMALL = {"linewidth": 5, "markersize": 9}  # in the legend


@styled
def draw_work_precision(
    dataset: xr.Dataset, eps: float | None = None, gamma: float | None = None
) -> Figure:
    r"""Draw a data set of `work_precision`, `dataset`.

    Above, of one cell: error against seconds, one line a method, thin from the fastest to
    the slowest of its warm runs, and below it in yellow the Pareto front of the runs that
    are not wrong; accuracy reached against accuracy asked for, several methods side by
    side around it. The cell: of `eps` (m) and `gamma`; the smallest eps and gamma = 1 where
    none is named. Below, with more than one cell: seconds, and error over accuracy, at the
    accuracy in the middle: against eps, one panel for each gamma, or with one eps against
    gamma.

    Runs that are not done stand above the upper edge of each panel. Errors below what the
    reference can judge are drawn there, those beyond 1000 eps there.

    Raises `ValueError` for an eps or gamma that the data set does not hold.

    >>> costs = fx.work_precision(scene, methods="auto", accuracies=1e-3, repeats=1)
    >>> [axes.get_xlabel() for axes in fx.plot.draw_work_precision(costs).axes]
    ['seconds of a warm run', 'accuracy asked for ($\\epsilon$)']
    """
    gamma = choose_gamma(dataset, gamma)
    smallest = float(dataset.eps.min())
    chosen = smallest if eps is None else float(choose_eps(dataset, gamma, eps)[0])
    columns = columns_below(dataset)
    heights = [4.2] + [3.3 * min(columns, 2)] * (columns > 0)  # inches
    size = max(11.0, 3.4 * columns), 1.3 + sum(heights)
    figure = Picture(figsize=size, layout="constrained")
    grid = figure.add_gridspec(len(heights), 1, height_ratios=heights)
    cell = dataset.sel(gamma=gamma, eps=chosen)
    left, right = grid[0].subgridspec(1, 2).subplots()
    _times(left, cell)
    _calibration(right, cell)
    if columns:
        draw_cells(grid[1], dataset)
    _legends(figure, dataset)
    return figure


def _lines(cell: xr.Dataset):
    """For each method its look and its runs."""
    for index, name in enumerate(cell.solver.values):
        yield look(str(name), index), runs_of(cell.sel(solver=name))


def _times(axes: Any, cell: xr.Dataset) -> None:
    axes.set(xscale="log", yscale="log", xlabel="seconds of a warm run")
    points, failed = [], []
    for style, runs in _lines(cell):
        right, wrong = runs.drawn & ~runs.wrong, runs.drawn & runs.wrong
        axes.plot(runs.seconds[runs.drawn], runs.errors[runs.drawn], **style)
        axes.plot(runs.seconds[wrong], runs.errors[wrong], **WRONG)
        _draw_spread(axes, runs, style["color"])
        points.append(np.stack([runs.seconds[right], runs.errors[right]]))
        failed.append(runs.seconds[runs.failed & np.isfinite(runs.seconds)])
    front = _front(np.concatenate(points, axis=1))
    axes.plot(*front, zorder=1, solid_capstyle="round", **_FRONT)
    axes.set_ylabel("largest error of z outside slips ($\\epsilon$)")
    where = f"$\\epsilon$ = {float(cell.eps):.3g} m, $\\gamma$ = {float(cell.gamma):.3g}"
    axes.set_title(f"What accuracy costs: lower left is better  ({where})")
    if np.any(cell.error > MOST):
        axes.axhline(MOST, **_CAP)
    _floor(axes, float(floor_of(cell)))
    mark_failed([axes], [failed], levels=True)
    _few_seconds(axes)


def _few_seconds(axes: Any) -> None:
    """Within two decades 1, 2 and 5 of each: powers of ten and factors run together."""
    low, high = axes.get_xlim()
    if high < 100 * low:
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())


def _draw_spread(axes: Any, runs: DrawnRuns, shade: str) -> None:
    """From the fastest to the slowest run of each."""
    ends, errors = runs.spread[:, runs.drawn], runs.errors[runs.drawn]
    points = np.stack([ends, np.broadcast_to(errors, ends.shape)], axis=-1)
    lines = LineCollection(list(points.swapaxes(0, 1)), color=shade, **_SPREAD)
    axes.add_collection(lines, autolim=False)
    axes.update_datalim(points.reshape(-1, 2))  # exactly: limits do not hang on rounding


def _front(points: np.ndarray) -> np.ndarray:
    """Points that no other beats in both, in the order of their times."""
    order = np.lexsort(points[::-1])
    ordered = points[:, order]
    best = np.minimum.accumulate(ordered[1])
    better = np.ones(order.size, dtype=bool)
    better[1:] = ordered[1, 1:] < best[:-1]
    return ordered[:, better]


def _floor(axes: Any, error: float) -> None:
    """Below the reference's own error nothing is known."""
    low, high = axes.get_ylim()
    if low <= 0:  # nothing is drawn
        low, high = 1 / MOST, MOST
        axes.set_ylim(low, high)
    if error > low:
        axes.axhspan(low, min(error, high), color=UNKNOWN, zorder=0.5)
        axes.set_ylim(low, high)
    if error >= MOST:
        axes.annotate("no reference to judge by", (0.5, 0.5), **_MIDDLE)


def _calibration(axes: Any, cell: xr.Dataset) -> None:
    asked = cell.accuracy.values
    axes.set(yscale="log")
    set_places(axes, asked)
    ends = np.array(axes.get_xlim())
    places = apart(asked, cell.solver.size)
    failed = []
    for where, (style, runs) in zip(places, _lines(cell), strict=True):
        axes.plot(where[runs.drawn], runs.errors[runs.drawn], **style)
        wrong = runs.drawn & runs.wrong
        axes.plot(where[wrong], runs.errors[wrong], **WRONG)
        failed.append(where[runs.failed])
    stairs = _stairs(np.sort(asked), ends)
    axes.plot(*stairs, color=LIMIT, linewidth=1)
    if np.any(cell.error > MOST):
        axes.axhline(MOST, **_CAP)
    _floor(axes, float(floor_of(cell)))
    low, high = axes.get_ylim()
    axes.fill_between(*stairs, high, color=TOO_LITTLE, zorder=0)
    axes.set_ylim(low, high)
    axes.set_xlabel("accuracy asked for ($\\epsilon$)" + beside_each_other(cell))
    axes.set_ylabel("error reached ($\\epsilon$)")
    axes.set_title("Is the accuracy kept?  (above the line: no)")
    mark_failed([axes], [failed])


def _stairs(values: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A step at each value, as wide as the methods beside it are apart.

    (On the straight line methods that were moved to the side of what was asked of them
    stood above it where they kept it, and below where not.)
    """
    edges = np.concatenate([ends[:1], np.sqrt(values[1:] * values[:-1]), ends[1:]])
    return np.repeat(edges, 2)[1:-1], np.repeat(values, 2)


def _legends(figure: Any, dataset: xr.Dataset) -> None:
    """Methods above the panels; what else there is to see, below them."""
    methods = []
    for index, name in enumerate(map(str, dataset.solver.values)):
        label = f"{name}{_undone(dataset.sel(solver=name))}"
        methods.append(Line2D([], [], label=label, **look(name, index)))
    figure.legend(handles=methods, loc="outside upper center", ncols=4)
    signs: list[Any] = [
        Line2D([], [], **_FRONT | _SMALL, label="nothing is both faster and more accurate")
    ]
    if np.any(dataset.wrong > 0):
        signs.append(
            Line2D(
                [], [], **WRONG, label="success reported, half an $\\epsilon$ or more off"
            )
        )
    if np.any(dataset.error > MOST):
        signs.append(Line2D([], [], **_CAP, label="1000 $\\epsilon$ and more"))
    if np.any(failed_runs(dataset)):
        why = "too slow, or failed"
        if np.any(untried_runs(dataset)):
            why = "too slow, failed, or not tried"
        signs.append(Line2D([], [], color=LIMIT, **NOT_DONE, label=f"not done: {why}"))
    signs += [
        Patch(color=TOO_LITTLE, label="less accurate than asked for"),
        Patch(color=UNKNOWN, label="below the error of the reference"),
    ]
    figure.legend(handles=signs, loc="outside lower center", ncols=3)


def _undone(runs: xr.Dataset) -> str:
    """How many runs of a method are not done, and how many of all were not tried."""
    failed, untried = int(failed_runs(runs).sum()), int(untried_runs(runs).sum())
    counts = {"not done": failed - untried, "not tried": untried}
    told = [f"{n} of {runs.status.size} {what}" for what, n in counts.items() if n]
    return f" ({', '.join(told)})" if told else ""
