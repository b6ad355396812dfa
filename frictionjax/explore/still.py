"""The page as a picture, for readers without a kernel."""

from typing import Any

import numpy as np

from ..plot import colour, new_figure, styled
from .explored import Explored
from .setting import SLIDERS

_INK = "#222222"
_NAMES = {"rho_plus": "$\\rho_+$", "rho_minus": "$-\\rho_-$", "ratio": "ratio"}


@styled
def draw_still(found: Explored, title: str = "") -> Any:
    """Draw potential, friction loop and coefficients, as the page does."""
    figure, grid = new_figure(1, 3, 11.4, 3.8)
    wells, loop, bars = grid[0]
    _wells(wells, found)
    _loop(loop, found)
    _bars(bars, found)
    where = zip(SLIDERS, found.setting, strict=True)
    told = ", ".join(f"{s.name} = {v:.3g} {s.unit}".strip() for s, v in where)
    figure.suptitle(f"{told}\n{title}" if title else told, fontsize=9.5, color="#555555")
    return figure


def _wells(axes: Any, found: Explored) -> None:
    axes.plot(found.wells, 1e3 * found.energy, color=colour(0))
    start = 1e3 * np.interp(0.0, found.wells, found.energy)
    axes.plot([0.0], [start], "o", color=colour(1))
    axes.set(xlabel="z/eps (periods)", ylabel="$V_\\epsilon$ (mJ)")
    axes.set_title("Wiggly potential, tip at t = 0")
    axes.margins(x=0)


def _loop(axes: Any, found: Explored) -> None:
    axes.plot(found.z, found.force, color=colour(0), linewidth=1, label="wiggly")
    axes.plot(found.z_limit, found.force_limit, "--", color=_INK, label="limit")
    axes.set(xlabel="z (m)", ylabel="$\\ell - \\Phi'(z)$ (N)", title="Friction loop")
    axes.legend(loc="center", bbox_to_anchor=(0.29, 0.5))  # beside where it sets off


def _bars(axes: Any, found: Explored) -> None:
    numbers = found.coefficients
    heights = [numbers["rho_plus"], -numbers["rho_minus"], numbers["ratio"]]
    places = np.arange(3)[::-1]
    bars = axes.barh(places, heights, color=[colour(0), colour(1), colour(2)], height=0.5)
    texts = [f"{heights[0]:.4f} N", f"{heights[1]:.4f} N", f"{heights[2]:.3f}"]
    axes.bar_label(bars, texts, padding=4)
    axes.set_yticks(places, list(_NAMES.values()))
    axes.set(xlabel="N, and the ratio", title="Coefficients", xlim=(0, 1.35 * max(heights)))
    axes.grid(False)
