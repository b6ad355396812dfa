"""Grids of eps: how closely each gives the order, and how long it takes."""

from typing import Any

import numpy as np

from ..._checks import require
from ..style import GUIDE, LIMIT, axes_of, colour, styled


@styled
def draw_order_cost(found: Any, ax: Any = None) -> Any:
    """Draw what `order_cost` has `found`: half widths of intervals over seconds, by grid.

    A Figure, or `ax` where it is drawn into that.

    Filled: grids that those at smaller eps confirm, or that reach the end of the range,
    with none to compare with; hollow: the others; the line goes through the front, the
    filled ones that no cheaper one beats; the ring is the choice.

    Raises `ValueError` where no grid gives an order.

    >>> cost = fx.order_cost(scene, eps=[1e-2, 1e-4], within=0.1, measure=False)
    >>> figure = fx.plot.draw_order_cost(cost)
    >>> figure.axes[0].get_legend_handles_labels()[1][0]
    'confirmed, or at the end of the range'
    """
    require(bool(found.grids), "found", found.message, "grids that give an order")
    drawn, axes = axes_of(ax, 6.4, 4.6)
    for confirmed, name, fill in (
        (True, "confirmed, or at the end of the range", colour(0)),
        (False, "not confirmed", "white"),
    ):
        some = [grid for grid in found.grids if grid.confirmed == confirmed]
        if some:
            look = {"color": colour(0) if confirmed else GUIDE, "markerfacecolor": fill}
            axes.plot(*_places(some), "o", **look, markersize=4, label=name)
    if found.front:
        axes.plot(*_places(found.front), color=LIMIT, lw=1.0, label="front")
    if found.choice is not None:
        told = f"choice: {found.choice.points} eps, order {found.choice.order:.3g}"
        ring: dict[str, Any] = {"markerfacecolor": "none", "markersize": 12}
        axes.plot(*_places([found.choice]), "o", color=colour(1), **ring, label=told)
    axes.set(xscale="log", yscale="log", xlabel="predicted time (s)")
    axes.set(ylabel="half width of the 95% interval of the order (1)")
    axes.set_title("Grids of eps" if found.success else "Grids of eps: none recommended")
    axes.legend(loc="best")
    return drawn


def _places(grids: list[Any]) -> tuple[np.ndarray, np.ndarray]:
    seconds = np.array([grid.seconds for grid in grids])
    return seconds, np.array([grid.half_width for grid in grids])
