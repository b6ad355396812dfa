"""What a study returns, and how it shows itself."""

import html
from typing import Any, NamedTuple

import xarray as xr

from .._text import ResultTable, require_no_axes
from .study_tables import failed_table, order_table, spread_table


class Study(NamedTuple):
    """Result of `study`.

    `orders`: over gamma; `local_orders`: over gamma and neighbouring pairs of eps;
    `failed`: one dict for each cell that failed, with gamma, eps, status and message;
    `curves`: over gamma and eps, what the laws predict for each error and what was fitted.
    Of several scenes all have the dimension `scene` in front, failed cells their scene,
    and `spread` holds quantiles of orders and constants over the scenes; else it is None.
    """

    orders: xr.Dataset
    local_orders: xr.Dataset
    failed: list[dict[str, Any]]
    dataset: xr.Dataset
    curves: xr.Dataset
    spread: xr.Dataset | None = None

    def table(self) -> ResultTable:
        """Orders and constants for eps -> 0, a line for each error and gamma.

        Of several scenes how they spread.

        >>> data = fx.sweep(scene, eps=[0.1, 0.03, 0.01, 0.003, 0.001], gamma=1.0)
        >>> fx.study(data).table()
        error           gamma           order [95%]  predicted    law   seen ...
        state               1  1.010 [0.874, 1.147]          1  slips  1.094 ...
        dissipation         1  1.055 [0.925, 1.186]          1  slips  1.427 ...
        from the strip      1  1.333 [1.326, 1.338]      1.333  slips  1.368 ...
        """
        if self.spread is not None:
            return spread_table(self.spread)
        return order_table(self.orders)

    def __repr__(self) -> str:
        return f"{self.table()}\n{failed_table(self.failed)}"

    def _repr_html_(self) -> str:
        failed = html.escape(failed_table(self.failed))
        return f"{self.table()._repr_html_()}<pre>{failed}</pre>"

    def plot(self, ax: Any = None, figure: Any = None) -> Any:
        r"""Errors against eps with the fitted orders, as a matplotlib Figure.

        Of several scenes: the errors of all, and how their orders spread.

        `figure`: a matplotlib Figure or SubFigure to draw into; `ax` is refused, as the
        picture has several axes.

        >>> data = fx.sweep(scene, eps=[0.1, 0.03, 0.01, 0.003, 0.001], gamma=1.0)
        >>> figure = fx.study(data).plot()
        >>> figure.savefig("orders.png")
        >>> print(figure.axes[0].get_legend().get_texts()[0].get_text())
        $\gamma$ = 1: order 1.09 at these $\epsilon$;
        for $\epsilon \to 0$: 1.01, 95% [0.87, 1.15], law: slips
        """
        require_no_axes(ax)
        from ..plot import draw_convergence, draw_scenes

        if self.spread is not None:
            return draw_scenes(self.dataset, self.orders, figure)
        return draw_convergence(self.dataset, self.orders, self.curves, figure)
