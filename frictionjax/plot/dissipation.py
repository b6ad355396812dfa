"""Energy dissipated since the start."""

from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from .._checks import require
from ..sweeps import whole_grid
from .style import (
    LIMIT,
    choose_eps,
    choose_gamma,
    label_eps,
    new_figure,
    shades,
    styled,
)


@styled
def draw_dissipation(
    dataset: xr.Dataset, gamma: float | None = None, eps: Any = None
) -> Figure:
    """Draw `int_0^t eps^gamma z'^2` (J) for a few eps of one gamma, and the limit's.

    Raises `ValueError` for a data set without dissipation.
    """
    dataset = whole_grid(dataset)
    known = "dissipation" in dataset
    require(known, "dataset", "no dissipation", "the variable dissipation of a sweep")
    gamma = choose_gamma(dataset, gamma)
    chosen = choose_eps(dataset, gamma, eps)
    figure, grid = new_figure(1, 1, 7.2, 4.4)
    axes, t = grid[0, 0], dataset.time.values
    for value, shade in zip(chosen, shades(chosen.size), strict=True):
        spent = dataset.dissipation.sel(gamma=gamma, eps=value)
        axes.plot(t, spent, color=shade, label=label_eps(value))
    axes.plot(t, dataset.dissipation_limit, "--", color=LIMIT, linewidth=1.3, label="limit")
    axes.set(xlabel="t (s)", ylabel="dissipated energy D (J)")
    axes.set_title(f"Dissipation, $\\gamma$ = {gamma:.3g}")
    axes.margins(x=0)
    axes.legend(loc="upper left")
    return figure
