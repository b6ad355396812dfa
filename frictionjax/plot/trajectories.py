"""Trajectories and dissipation of the wiggly system over those of the limit."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from .._checks import require
from ..sweeps import whole_grid
from .style import (
    DOTS,
    LIMIT,
    STRIP,
    TOLD_OF_DOTS,
    choose_eps,
    choose_gamma,
    follows_slips,
    label_eps,
    new_figure,
    shades,
    styled,
)

_DOTS = DOTS | {"markersize": 5}  # few of them are in the close-up
_SLIPS = 5  # in the inset
_RESOLVED = 8  # samples a slip, or the inset would show the sampling


@styled
def draw_trajectories(
    dataset: xr.Dataset, gamma: float | None = None, eps: Any = None
) -> Figure:
    r"""Draw `z_eps` for a few eps of one gamma over the limit `z`, the strip shaded.

    `dataset`: of `sweep`. `gamma`: the nearest to 1 where None; `eps`: largest, smallest
    and one between where None. A panel beside it follows a few slips of the largest eps
    whose slips the times resolve; an eps whose slips are finer than the times is drawn as
    dots there.

    Raises `ValueError` for a gamma or an eps that the data set does not hold.

    >>> data = fx.sweep(scene, eps=[0.1, 0.03, 0.01], gamma=1.0)
    >>> figure = fx.plot.draw_trajectories(data)
    >>> figure.axes[0].get_legend_handles_labels()[1]
    ['strip [z$_-$, z$_+$]', '$\\epsilon$ = 0.1 m', '$\\epsilon$ = 0.03 m', ...
    """
    dataset = whole_grid(dataset)
    gamma = choose_gamma(dataset, gamma)
    chosen = choose_eps(dataset, gamma, eps)
    lines = dict(zip(chosen, shades(chosen.size), strict=True))
    window = _slips(dataset, gamma, chosen)
    figure, grid = new_figure(1, 1 if window is None else 2, 7.2 + 3.6 * bool(window), 4.6)
    _panel(grid[0, 0], dataset, gamma, lines)
    grid[0, 0].set_title(f"Trajectories, $\\gamma$ = {gamma:.3g}")
    grid[0, 0].legend(loc="best")
    if window is not None:
        _zoom(grid[0, 0], grid[0, 1], dataset, gamma, lines, window)
    return figure


def _panel(
    axes: Any,
    dataset: xr.Dataset,
    gamma: float,
    lines: dict[float, Any],
    dotted: Sequence[float] = (),
) -> None:
    t = dataset.time.values
    axes.fill_between(
        t,
        dataset.z_minus,
        dataset.z_plus,
        color=STRIP,
        linewidth=0,
        label="strip [z$_-$, z$_+$]",
    )
    for eps, shade in lines.items():
        z, look = dataset.z.sel(gamma=gamma, eps=eps), _DOTS if eps in dotted else {}
        axes.plot(t, z, color=shade, label=label_eps(eps), **look)
    axes.plot(t, dataset.z_limit, "--", color=LIMIT, linewidth=1.2, label="limit z")
    axes.set(xlabel="t (s)", ylabel="z (m)")
    axes.margins(x=0)


def _slips(dataset: xr.Dataset, gamma: float, chosen) -> tuple[float, float] | None:
    """A window of a few slips: of the largest eps that slides and is resolved by `time`."""
    t, z = dataset.time.values, dataset.z_limit.values
    windows = (window_of_slips(t, z, float(eps)) for eps in chosen)
    return next((window for window in windows if window is not None), None)


def window_of_slips(t: np.ndarray, z: np.ndarray, eps: float) -> tuple[float, float] | None:
    """Times in s around a few slips where the limit `z` (m) is fastest.

    None where it does not slide, slips are finer than the times `t`, or it is all one
    window.
    """
    if t.size < 3:
        return None
    speed = np.abs(np.gradient(z, t)) if np.all(np.diff(t) > 0) else np.zeros(t.size)
    middle = int(np.argmax(speed))
    if speed[middle] == 0:
        return None
    slip = eps / speed[middle]
    half = 0.5 * _SLIPS * slip
    fine = slip >= _RESOLVED * float(np.median(np.diff(t)))
    if not (fine and 2 * half < 0.5 * (t[-1] - t[0])):
        return None
    centre = float(np.clip(t[middle], t[0] + half, t[-1] - half))
    return centre - half, centre + half


def _zoom(main: Any, axes: Any, dataset: xr.Dataset, gamma: float, lines, window) -> None:
    inside, states = dataset.sel(time=slice(*window)), dataset.z.sel(gamma=gamma)
    dotted = [eps for eps in lines if not follows_slips(states.sel(eps=eps).values, eps)]
    _panel(axes, inside, gamma, lines, dotted)
    shown = [inside.z.sel(gamma=gamma, eps=eps).values for eps in lines]
    values = np.concatenate([*shown, inside.z_limit.values])
    frame_window(main, axes, window, values)
    if dotted:
        axes.set_title(f"A few slips, in the frame{TOLD_OF_DOTS}")


def frame_window(main: Any, axes: Any, window: Any, values: np.ndarray) -> None:
    """Make `axes` the close-up of a window of `main`, which gets a frame there."""
    pad = 0.06 * np.ptp(values)
    low, high = float(values.min() - pad), float(values.max() + pad)
    axes.set(xlim=window, ylim=(low, high), title="A few slips, in the frame on the left")
    axes.locator_params(axis="x", nbins=5)
    width, height = window[1] - window[0], high - low
    frame = Rectangle((window[0], low), width, height, fill=False, zorder=5)
    frame.set(edgecolor="#555555", linewidth=1)
    main.add_patch(frame)


@styled
def draw_dissipation(
    dataset: xr.Dataset, gamma: float | None = None, eps: Any = None
) -> Figure:
    """Draw `int_0^t eps^gamma z'^2` (J) for a few eps of one gamma, and the limit's.

    `dataset`: of `sweep`; `gamma`, `eps` (m): as in `draw_trajectories`.

    Raises `ValueError` for a data set without dissipation.

    >>> data = fx.sweep(scene, eps=[0.1, 0.03, 0.01], gamma=1.0)
    >>> print(fx.plot.draw_dissipation(data).axes[0].get_ylabel())
    dissipated energy D (J)
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
