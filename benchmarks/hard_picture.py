"""Small multiples of the hard scenes, one panel each."""

import textwrap
from pathlib import Path

import numpy as np
from entry import pull
from matplotlib.figure import Figure

import frictionjax as fx
from frictionjax.model.strip import strips_at
from frictionjax.plot.style import COLOURS, GUIDE, LIMIT, STRIP, styled

_COLUMNS = 6
_SAMPLES = 600
_PERIODS = 12  # slip periods of a long slide that are shown


def _window(one) -> tuple[float, float]:
    """Times to show: all of some tens of wells, else the way into a slide."""
    if one.window is not None:
        return one.window
    period = one.eps * one.system.stiffness / one.system.rate
    end = one.system.duration
    if end < 800 * period:
        return 0.0, end
    begin = 0.9 * one.system.kinks[0]
    return begin, begin + _PERIODS * period


def _surface(axes, one) -> None:
    """The wiggles' force over two periods, and its extremes."""
    y = np.linspace(0, 2, 801)
    force = np.array([pull(one, v) for v in y])
    for edge in (force.min(), force.max()):
        axes.axhline(edge, color=GUIDE, lw=0.8, ls="--")
    axes.plot(y, force, color=COLOURS[1], lw=1.2)
    axes.set_xlabel("tip y", labelpad=1)
    axes.set_ylabel("V' in N", labelpad=1)


def _trajectory(axes, one) -> None:
    """z in wells, counted from where the panel begins, and the strip."""
    scene, (begin, end) = one.build(), _window(one)
    ts = np.linspace(begin, end, _SAMPLES)
    z = np.asarray(fx.solve(scene, one.eps, one.gamma, ts).z) / one.eps
    law = fx.friction(scene)
    rho = float(law.rho_plus), float(law.rho_minus)
    _, low, high = (np.asarray(v) / one.eps for v in strips_at(scene, *rho, ts))
    origin = np.round(z[0]) if begin > 0 else z[0] if np.ptp(z) < 0.01 else 0.0
    scale = 10.0 ** np.floor(np.log10(np.ptp(z))) if np.ptp(z) < 0.01 else 1.0
    z, low, high = ((v - origin) / scale for v in (z, low, high))
    shown, unit = ts - begin, f"t - {begin:.3g} s, in s" if begin else "t in s"
    axes.fill_between(shown, low, high, color=STRIP, lw=0)
    axes.plot(shown, z, color=COLOURS[0], lw=1.1)
    room = 0.15 * np.ptp(z)
    axes.set_ylim(z.min() - room, z.max() + room)
    axes.set_xlabel(unit, labelpad=1)
    wells = "z/eps" if scale == 1 else f"z/eps in {scale:.0e}"
    axes.set_ylabel(f"{wells} - {origin:.5g}" if abs(origin) > 1 else wells, labelpad=1)


@styled
def draw(scenes, path: Path) -> Figure:
    """Draw all scenes and save them at `path`."""
    rows = -(-len(scenes) // _COLUMNS)
    figure = Figure(figsize=(2.75 * _COLUMNS, 2.35 * rows), layout="constrained")
    every = figure.subplots(rows, _COLUMNS, squeeze=False).ravel()
    for axes, (name, one) in zip(every, scenes.items(), strict=False):
        (_surface if one.surface else _trajectory)(axes, one)
        why = textwrap.fill(one.why, 34)
        axes.text(0, 1.03, why, transform=axes.transAxes, fontsize=8, va="bottom")
        lines = why.count("\n") + 1
        axes.set_title(name + "\n" * lines, fontsize=10, fontweight="bold", color=LIMIT)
        axes.xaxis.label.set_size(8)
        axes.yaxis.label.set_size(8)
        axes.tick_params(labelsize=7.5, length=2)
        axes.locator_params(nbins=4)
        for axis in (axes.xaxis, axes.yaxis):
            axis.get_offset_text().set_size(7)
    for axes in every[len(scenes) :]:
        axes.set_axis_off()
    figure.savefig(path, dpi=80, pil_kwargs={"optimize": True})
    return figure
