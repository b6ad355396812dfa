"""Errors against eps, with the fitted orders."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullLocator

from ..convergence import Verdict
from ..sweeps import whole_grid
from .style import GUIDE, colour, marker, new_figure, styled

_PANELS = (
    ("", "sup_error", "sup$_t$ |z$_\\epsilon$ - z| (m)", "State: distance from the limit"),
    (
        "dissipation_",
        "dissipation_error",
        "sup$_t$ |D$_\\epsilon$ - D| (J)",
        "Dissipated energy: distance from the limit",
    ),
    (
        "strip_",
        "strip_excess",
        "sup$_t$ dist(z$_\\epsilon$, strip) (m)",
        "State: distance from the strip",
    ),
)
_GRAPHS = (
    _PANELS[0],
    (
        "graph_",
        "graph_error",
        "distance of graphs (m)",
        "State: distance of graphs, jumps filled",
    ),
    (
        "dissipation_graph_",
        "dissipation_graph_error",
        "distance of graphs (J)",
        "Dissipated energy: distance of graphs",
    ),
)

_NUMBERS = (
    *("order", "order_low", "order_high", "order_seen"),
    *("eps_min", "eps_max", "constant", "misfit"),
)
_MANY_DECADES = 3
_LINE = 0.17  # inches
_DIFFERS = 0.05  # of orders: what the points show is said too
_GREY = "#666666"
_NAME = 15.0  # points from the name of a guide to that of the next, with its exponent
_ENTRY = 2.6  # inches, of the key


@styled
def draw_convergence(
    dataset: xr.Dataset,
    orders: xr.Dataset,
    curves: xr.Dataset | None = None,
    figure: Any = None,
) -> Any:
    r"""Draw the errors of a sweep against eps, log-log, one line for each gamma.

    `orders`, `curves`: those of `study(dataset)`; without the latter what was fitted is
    drawn as a power, and no law. Filled points are in the window that the fitted
    line rests on, hollow ones are outside; a cross on the axis is a failed cell, a triangle
    there an error of 0. Dotted guides have the slope `eps^beta` of the lemmas, which say
    nothing of scenes with noise. A second panel shows the dissipation, where the data set
    has it; of a rod that turns over others show distances of graphs.
    `figure`: a matplotlib Figure or SubFigure to draw into, which is returned.

    >>> data = fx.sweep(scene, eps=[0.1, 0.03, 0.01, 0.003, 0.001], gamma=1.0)
    >>> figure = fx.plot.draw_convergence(data, fx.study(data).orders)
    >>> print(figure.axes[0].get_legend().get_texts()[0].get_text())
    $\gamma$ = 1: order 1.09 at these $\epsilon$;
    for $\epsilon \to 0$: 1.01, 95% [0.87, 1.15], law: slips
    """
    dataset = whole_grid(dataset)
    chosen = _GRAPHS if "graph_error" in dataset else _PANELS
    panels = [panel for panel in chosen if panel[1] in dataset]
    drawn, grid = new_figure(1, len(panels), 5.4 * len(panels), 5.2, figure)
    for axes, (prefix, name, label, title) in zip(grid[0], panels, strict=True):
        for index, gamma in enumerate(dataset.gamma.values):
            cells, fit = dataset.sel(gamma=gamma), _fit(orders.sel(gamma=gamma), prefix)
            _errors(axes, cells, fit, name, index)
            if curves is not None:
                _curves(axes, curves.sel(gamma=gamma), fit, name, index)
            _failures(axes, cells, index)
            _zeros(axes, cells, name, index)
        if not any(_good(dataset.sel(gamma=g), name)[0].size for g in dataset.gamma):
            axes.set_ylim(0.1, 1.0)  # a log axis without data has no range of its own
        axes.set(xscale="log", yscale="log", ylabel=label, title=title)
        axes.set_xlabel("$\\epsilon$ (m)")
        if not prefix and "noise_order" not in orders:  # of which the lemmas are not
            _guides(axes, dataset)
        _fewer_ticks(axes)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14))
    if figure is None:
        _make_room(drawn)
    _key(drawn)
    return drawn


def _key(figure: Any) -> None:
    """What points and lines are, of all panels and gammas alike."""
    point: dict[str, Any] = {"color": _GREY, "marker": "o", "linestyle": "none"}
    law: dict[str, Any] = {"color": _GREY, "linewidth": 0.9, "alpha": 0.7}
    slope: dict[str, Any] = {"color": GUIDE, "linewidth": 1}
    handles = [
        Line2D([], [], **point, label="in the window of the fit"),
        Line2D([], [], **point, markerfacecolor="white", label="left out"),
        Line2D([], [], color=_GREY, label="fit: its order and 95% interval above"),
        Line2D([], [], **law, linestyle="--", label="theory: the law"),
        Line2D([], [], **slope, linestyle=":", label="theory: slope of the lemmas"),
    ]
    drawn = {line.get_linestyle() for axes in figure.axes for line in axes.lines}
    handles = handles[:3] + [one for one in handles[3:] if one.get_linestyle() in drawn]
    fit = int(figure.bbox.width / figure.dpi / _ENTRY)
    columns = min(max(fit, 1), len(handles))
    figure.legend(handles=handles, loc="outside lower center", ncols=columns)


def _make_room(figure: Figure) -> None:
    """For second lines of legends, which would be taken from the axes."""
    legends = [axes.get_legend() for axes in figure.axes]
    texts = [legend.get_texts() for legend in legends if legend is not None]
    lines = max(sum("\n" in one.get_text() for one in some) for some in texts)
    figure.set_figheight(figure.get_figheight() + _LINE * lines)


def _fewer_ticks(axes: Any) -> None:
    """Minor ticks only where decades are few: they took 0.5 s of the 0.8 s of a picture."""
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        if high > 10**_MANY_DECADES * low:
            axis.set_minor_locator(NullLocator())


def _fit(orders: xr.Dataset, prefix: str) -> dict[str, Any]:
    numbers = {name: float(orders.get(prefix + name, np.nan)) for name in _NUMBERS}
    verdict = int(orders.get(f"{prefix}verdict", Verdict.TOO_FEW_POINTS))
    law = orders[f"{prefix}law"].item() if f"{prefix}law" in orders else "free"
    return numbers | {"law": str(law), "verdict": verdict}


def _good(cells: xr.Dataset, name: str) -> tuple[np.ndarray, np.ndarray]:
    """eps and errors of the cells that can be trusted and drawn on a log axis."""
    errors = cells[name].values
    known = (cells.status.values == 0) & np.isfinite(errors) & (errors > 0)
    return cells.eps.values[known], errors[known]


def _errors(axes: Any, cells: xr.Dataset, fit: dict[str, Any], name: str, index: int):
    eps, errors = _good(cells, name)
    inside = (eps >= 0.999 * fit["eps_min"]) & (eps <= 1.001 * fit["eps_max"])
    look = {"color": colour(index), "marker": marker(index), "linestyle": "none"}
    axes.plot(eps[~inside], errors[~inside], **look, markerfacecolor="white")
    axes.plot(eps[inside], errors[inside], **look)
    drawn = fit["verdict"] != Verdict.NO_POWER and fit["law"] == "free"
    ends = np.array([fit["eps_min"], fit["eps_max"]]) if drawn else np.array([np.nan])
    axes.plot(
        ends,
        fit["constant"] * ends ** fit["order"],
        color=colour(index),
        marker=marker(index),
        markevery=[],
        label=_legend(float(cells.gamma), fit),
    )


def _curves(
    axes: Any, curves: xr.Dataset, fit: dict[str, Any], name: str, index: int
) -> None:
    """What the law predicts, and in the window of the fit the curve that was fitted."""
    eps, look = curves.eps.values, {"color": colour(index), "marker": "none"}
    if f"{name}_predicted" in curves:
        predicted = curves[f"{name}_predicted"].values
        axes.plot(eps, predicted, "--", linewidth=0.9, alpha=0.7, **look)
    inside = (eps >= 0.999 * fit["eps_min"]) & (eps <= 1.001 * fit["eps_max"])
    if fit["law"] != "free" and fit["verdict"] != Verdict.NO_POWER:
        axes.plot(eps[inside], curves[f"{name}_fitted"].values[inside], **look)


def _legend(gamma: float, fit: dict[str, Any]) -> str:
    name = f"$\\gamma$ = {gamma:.3g}:"
    if not np.isfinite(fit["order"]):
        return f"{name} too few points for an order"
    if fit["verdict"] == Verdict.NO_POWER:
        return f"{name} no power of $\\epsilon$, points {fit['misfit']:.2g} times off"
    return f"{name} {_order(fit)}"


def _order(fit: dict[str, Any]) -> str:
    """Order for eps -> 0, after that of the points themselves where it is another."""
    interval = f"95% [{fit['order_low']:.2f}, {fit['order_high']:.2f}]"
    law = "" if fit["law"] == "free" else f", law: {fit['law']}"
    unseen = ", not yet seen" if fit["verdict"] == Verdict.NOT_YET_SEEN else ""
    text = f"{fit['order']:.2f}, {interval}{law}{unseen}"
    # Written so that an order which is not known says nothing.
    if not abs(fit["order_seen"] - fit["order"]) > _DIFFERS:
        return f"order {text}"
    return (
        f"order {fit['order_seen']:.2f} at these $\\epsilon$;\n"
        f"for $\\epsilon \\to 0$: {text}"
    )


def _failures(axes: Any, cells: xr.Dataset, index: int) -> None:
    """Crosses on the axis where cells failed: they have no error to show."""
    _on_axis(axes, cells, cells.status.values != 0, "x", "failed", index)


def _zeros(axes: Any, cells: xr.Dataset, name: str, index: int) -> None:
    """Triangles on the axis where there is no error at all, which no log axis shows."""
    none = (cells.status.values == 0) & (cells[name].values == 0)
    _on_axis(axes, cells, none, "v", "0, below the axis", index)


def _on_axis(
    axes: Any, cells: xr.Dataset, some: np.ndarray, marker: str, told: str, index: int
) -> None:
    """Marks at the eps of `some` cells, which have no place in the panel."""
    eps = cells.eps.values[some]
    if eps.size:
        axes.plot(
            eps,
            np.full(eps.size, 0.025 * index),
            marker,
            color=colour(index),
            markersize=7,
            clip_on=False,
            transform=axes.get_xaxis_transform(),
            label=f"{told}, $\\gamma$ = {float(cells.gamma):.3g}",
        )


def _guides(axes: Any, dataset: xr.Dataset) -> None:
    """Slopes of the lemmas below the data, one for each different beta."""
    betas = np.minimum(1.0, dataset.gamma.values)
    ends = np.array([dataset.eps.values.min(), dataset.eps.values.max()])
    names: list[tuple[float, str]] = []
    for beta in np.unique(betas):
        group = dataset.isel(gamma=betas == beta)
        points = [_good(group.isel(gamma=i), "sup_error") for i in range(group.gamma.size)]
        points = [(eps, errors) for eps, errors in points if eps.size]
        if not points:
            continue
        below = 0.6 * min(float(np.min(errors / eps**beta)) for eps, errors in points)
        axes.plot(ends, below * ends**beta, ":", color=GUIDE, linewidth=1, zorder=1)
        name = "$\\epsilon$" if beta == 1 else f"$\\epsilon^{{{beta:.3g}}}$"
        names.append((float(below * ends[1] ** beta), name))
    _name_guides(axes, float(ends[1]), names)


def _name_guides(axes: Any, eps: float, names: list[tuple[float, str]]) -> None:
    """Beside the ends of the guides, moved up where one would touch the next below."""
    free = -np.inf
    axes.autoscale_view()  # or places below are of other limits
    for value, name in sorted(names):
        here = axes.transData.transform((eps, value))[1] * 72 / axes.figure.dpi
        up = max(0.0, free - here)
        free = here + up + _NAME
        axes.annotate(
            name,
            (eps, value),
            xytext=(4, up),
            textcoords="offset points",
            va="center",
            color="#666666",
            annotation_clip=False,
        )
