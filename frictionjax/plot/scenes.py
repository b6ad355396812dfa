"""Errors of many scenes against eps, and how their orders spread."""

from typing import Any

import numpy as np
import xarray as xr

from ..numerics import even_places
from .style import LIMIT, colour, new_figure, styled

_BAND = (0.05, 0.95)
_WIDTH = 0.25  # of the cloud of scenes at each gamma


@styled
def draw_scenes(dataset: xr.Dataset, orders: xr.Dataset, figure: Any = None) -> Any:
    """Draw the errors of several scenes against eps, and their orders against gamma.

    `orders`: those of `study(dataset)`. On the left each scene's errors as thin lines, the
    median and the band that holds 90% of the scenes; on the right a point for each scene,
    a line at the median, crosses at the orders that the laws predict.
    `figure`: a matplotlib Figure or SubFigure to draw into, which is returned.

    >>> smooth = scene.replace(profile=fx.profiles.Sine(slope=0.05))
    >>> data = fx.sweep([scene, smooth], eps=[0.1, 0.03, 0.01, 0.003, 0.001], gamma=1.0)
    >>> figure = fx.plot.draw_scenes(data, fx.study(data).orders)
    >>> print(figure.axes[1].get_ylabel())
    order of convergence
    """
    drawn, ((errors, spread),) = new_figure(1, 2, 10.8, 4.8, figure)
    for index, gamma in enumerate(dataset.gamma.values):
        _errors(errors, dataset.sel(gamma=gamma), index)
        _orders(spread, orders.sel(gamma=gamma), index)
    count = dataset.sizes["scene"]
    errors.set(
        xscale="log",
        yscale="log",
        xlabel="$\\epsilon$ (m)",
        ylabel="sup$_t$ |z$_\\epsilon$ - z| (m)",
        title=f"Distance from the limit: {count} scenes, median and 90% band",
    )
    errors.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=dataset.gamma.size)
    places = np.arange(dataset.gamma.size)
    spread.set_xticks(places, [f"{gamma:.3g}" for gamma in dataset.gamma.values])
    spread.set(
        xlabel="$\\gamma$",
        ylabel="order of convergence",
        title="Orders: one point a scene, line at the median",
        xlim=(-0.6, places.size - 0.4),
    )
    spread.plot([], [], "x", color=LIMIT, label="predicted by the law, scene by scene")
    spread.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14))
    return drawn


def _errors(axes: Any, cells: xr.Dataset, index: int) -> None:
    good = (cells.status.transpose("scene", "eps").values == 0).astype(float)
    values = cells.sup_error.transpose("scene", "eps").values
    values = np.where((good > 0) & (values > 0), values, np.nan)
    eps, look = cells.eps.values, {"color": colour(index), "marker": "none"}
    axes.plot(eps, values.T, linewidth=0.4, alpha=min(1.0, 8 / len(values)), **look)
    known = np.any(np.isfinite(values), axis=0)
    if not known.any():
        return
    low, middle, high = np.nanquantile(values[:, known], [_BAND[0], 0.5, _BAND[1]], axis=0)
    axes.fill_between(eps[known], low, high, color=colour(index), alpha=0.15, linewidth=0)
    label = f"$\\gamma$ = {float(cells.gamma):.3g}"
    axes.plot(eps[known], middle, label=label, **look)


def _orders(axes: Any, orders: xr.Dataset, index: int) -> None:
    found, predicted = orders.order.values, orders.order_predicted.values
    # Scattered by rank, so that scenes hide no others and a picture is always the same.
    rank = np.argsort(np.argsort(found))
    places = index + _WIDTH * (2 * even_places(rank.size)[rank] - 1)
    look = {"color": colour(index), "linestyle": "none", "markersize": 3.5}
    axes.plot(places, found, marker="o", alpha=0.6, **look)
    axes.plot(np.full(predicted.size, index + 0.38), predicted, "x", color=LIMIT)
    if np.isfinite(found).any():
        ends = [index - _WIDTH, index + _WIDTH]
        axes.plot(ends, [np.nanmedian(found)] * 2, color=colour(index), marker="none")
