"""Thermal noise: how paths are spread, and friction against speed and temperature."""

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from .style import LIMIT, colour, new_figure, shades, styled

if TYPE_CHECKING:
    import xarray as xr


@styled
def draw_histogram(data: "xr.Dataset") -> Figure:
    """Draw a `histogram`: shares of bins with their 95% intervals, and Boltzmann's density.

    `data`: the data set. Both over z in m.

    >>> noisy = scene.replace(effects=(fx.effects.Noise(temperature=1e-3),))
    >>> paths = fx.ensemble(noisy, 0.1, gamma=1.0, ts=[0.0, 3.0], paths=100, key=0)
    >>> figure = fx.plot.draw_histogram(fx.histogram(noisy, paths, bins=4))
    >>> figure.axes[0].get_legend_handles_labels()[1]
    ["Boltzmann's density", '100 paths, with 95% intervals']
    """
    figure, grid = new_figure(1, 1, 7.2, 4.4)
    axes = grid[0, 0]
    edges = [*data.z_left.values, float(data.z_right[-1])]
    paths = int(data.attrs["paths"])
    axes.stairs(data.density, edges, color=colour(0), alpha=0.25, fill=True)
    spread = data.density - data.density_low, data.density_high - data.density
    axes.errorbar(
        data.z,
        data.density,
        yerr=spread,
        fmt=".",
        color=colour(0),
        elinewidth=1.0,
        markersize=3,
        label=f"{paths:,} paths, with 95% intervals",
    )
    law = {"color": LIMIT, "linewidth": 1.2, "label": "Boltzmann's density"}
    axes.plot(data.z_fine, data.boltzmann_density, **law)
    at = f"t = {data.attrs['time']:.4g} s, $T$ = {data.attrs['thermal_energy']:.3g} J"
    chance = f"p = {data.attrs['p_value']:.2g} ($\\chi^2$)"
    axes.set(xlabel="z (m)", ylabel="density (1/m)", title=f"{at}: {chance}")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


@styled
def draw_friction_curve(data: "xr.Dataset") -> Figure:
    """Draw a `friction_curve`: friction in N against speed in m/s, drag taken off.

    `data`: the data set. One line a temperature, dashed to the left; slides that failed are
    crosses on the axis. Of two temperatures and more a second panel is the map over both,
    to the right, or to the left where no speed is to the right.

    >>> data = fx.friction_curve(scene, speeds=[0.01, 0.1, 1.0], eps=0.01)
    >>> print(fx.plot.draw_friction_curve(data).axes[0].get_ylabel())
    friction less drag (N)
    """
    several = data.sizes.get("temperature", 1) > 1
    figure, grid = new_figure(1, 1 + several, 6.4 + 4.4 * several, 4.4)
    if "temperature" in data.dims:
        rows = [data.isel(temperature=i) for i in range(data.sizes["temperature"])]
    else:
        rows = [data]
    for row, shade in zip(rows, shades(len(rows)), strict=True):
        label = ""
        if "thermal_energy" in row:
            label = f"$T$ = {float(row.thermal_energy):.3g} J"
        _curve(grid[0, 0], row, shade, label)
    both = len(np.unique(np.sign(data.speed.values))) > 1
    if both:
        for style, way in (("-", "to the right"), ("--", "to the left")):
            grid[0, 0].plot([], [], style, color="0.3", label=way)
    if both or len(rows) > 1:
        under: Any = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.15), "ncols": 3}
        grid[0, 0].legend(**under)
    if several:
        _map(figure, grid[0, 1], data)
    return figure


def _curve(axes: Any, row: "xr.Dataset", shade: Any, label: str) -> None:
    friction = np.abs(row.friction_force.where(row.status == 0))
    for sign, style in ((1, "-"), (-1, "--")):
        side = np.sign(row.speed.values) == sign
        order = np.argsort(np.abs(row.speed.values[side]))
        speed = np.abs(row.speed.values[side])[order]
        shown = label if sign == np.sign(row.speed.values).max() else None
        look = {"color": shade, "linestyle": style, "marker": "o", "markersize": 3}
        axes.plot(speed, friction.values[side][order], label=shown, **look)
    failed = np.abs(row.speed.values[(row.status != 0).values])
    axes.plot(failed, 0 * failed, "x", color=shade, clip_on=False)
    axes.set_xscale("log")
    axes.set(xlabel="speed (m/s)", ylabel="friction less drag (N)", title="Friction")


def _map(figure: Any, axes: Any, data: "xr.Dataset") -> None:
    sign = 1 if (data.speed > 0).any() else -1
    side = data.isel(speed=np.flatnonzero(np.sign(data.speed.values) == sign))
    side = side.assign_coords(speed=np.abs(side.speed)).sortby("speed")
    side = side.sortby("temperature")
    friction = np.abs(side.friction_force.where(side.status == 0))
    friction = friction.transpose("temperature", "speed").values
    x, y = side.speed.values, side.thermal_energy.values
    mesh = axes.pcolormesh(x, y, friction, cmap="viridis", shading="nearest")
    bar = figure.colorbar(mesh, ax=axes, pad=0.02, label="friction less drag (N)")
    bar.outline.set_visible(False)
    if min(friction.shape) > 1 and np.ptp(friction[np.isfinite(friction)]) > 0:
        lines = axes.contour(x, y, friction, levels=8, colors="white", linewidths=0.8)
        axes.clabel(lines, fmt="%.3g", fontsize=8)
    axes.set(xscale="log", yscale="log")
    way = "right" if sign > 0 else "left"
    axes.set(xlabel="speed (m/s)", ylabel="$T_\\epsilon$ (J)", title=f"To the {way}")
    axes.grid(False)
