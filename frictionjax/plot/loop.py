"""Friction force against displacement."""

from typing import Any

import jax
import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from .._compile import Program
from ..coefficients import Coefficients
from ..supports import AbstractSupport
from ..sweeps import whole_grid
from .style import (
    DOTS,
    LIMIT,
    TOLD_OF_DOTS,
    choose_eps,
    choose_gamma,
    draw_level,
    follows_slips,
    label_eps,
    new_figure,
    shades,
    styled,
)

_JOINED: Any = {"linewidth": 1}


@styled
def draw_loop(
    dataset: xr.Dataset,
    support: AbstractSupport,
    found: Coefficients,
    gamma: float | None = None,
    eps: Any = None,
) -> Figure:
    r"""Draw the friction force `l - Phi'(z)` in N against `z` in m, for a few eps.

    `dataset`: of `sweep`; `gamma`, `eps` (m): as in `draw_trajectories`. `support` and
    `found` (of `friction`) belong to the scene of the data set. The limit's loop and
    `rho_plus`, `rho_minus` are drawn over it. An eps whose slips are finer than the times
    of the data set is drawn as dots: ask `sweep` for more `ts` to see them.

    Raises `ValueError` for a gamma or an eps that the data set does not hold.

    >>> data = fx.sweep(scene, eps=[0.1, 0.03, 0.01], gamma=1.0)
    >>> figure = fx.plot.draw_loop(data, scene.support, fx.friction(scene))
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['$\\rho_+$ = 0.12 N', '$\\rho_-$ = -0.0879 N']
    """
    dataset = whole_grid(dataset)
    gamma = choose_gamma(dataset, gamma)
    chosen = choose_eps(dataset, gamma, eps)
    figure, grid = new_figure(1, 1, 7.2, 4.6)
    axes = grid[0, 0]
    load, finer = dataset["load"].values, False
    for value, shade in zip(chosen, shades(chosen.size), strict=True):
        z = dataset.z.sel(gamma=gamma, eps=value).values
        joined = follows_slips(z, float(value))
        finer |= not joined
        look = _JOINED if joined else DOTS
        force = friction_force(support, load, z)
        axes.plot(z, force, color=shade, label=label_eps(value), **look)
    z = dataset.z_limit.values
    force = friction_force(support, load, z)
    axes.plot(z, force, "--", color=LIMIT, linewidth=1.4, label="limit")
    for name, level in (("\\rho_+", found.rho_plus), ("\\rho_-", found.rho_minus)):
        draw_level(axes, float(level), name)
    axes.margins(y=0.12)
    axes.set(xlabel="z (m)", ylabel="friction force $\\ell - \\Phi'(z)$ (N)")
    several = "s" if chosen.size > 1 else ""
    dots = TOLD_OF_DOTS if finer else ""
    axes.set_title(f"Friction loop{several} and limit, $\\gamma$ = {gamma:.3g}{dots}")
    below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.13)}  # names stand beside
    axes.legend(**below, ncols=min(chosen.size + 1, 4), markerscale=3)
    return figure


@Program
def _force(support: AbstractSupport, load, z):
    return load - jax.vmap(support.force)(z)


def friction_force(support: AbstractSupport, load, z) -> np.ndarray:
    """`l - Phi'(z)` in N, shapes (time,): what friction holds against."""
    return np.asarray(_force(support, np.asarray(load), np.asarray(z)))
