"""Forces of steady slides over eps, both ways."""

from typing import Any

import numpy as np

from ..._checks import require
from ..style import GUIDE, axes_of, colour, styled


@styled
def draw_steady_slide(slide: Any, ax: Any = None) -> Any:
    """Draw a `slide` of `steady_slide`: mean and peak forces over eps, both ways.

    A Figure, or `ax` where it is drawn into that.

    Points are means over time, the ends of the lines above them the largest forces. Slides
    that were not found are left out, and the title says how many.

    Raises `ValueError` where none was found.

    >>> slide = fx.steady_slide(scene.profile, scene.bristle, eps=[0.01, 0.001])
    >>> figure = fx.plot.draw_steady_slide(slide)
    >>> figure.axes[0].get_legend_handles_labels()[1]
    ['to the right', 'to the left']
    """
    eps, *forces = (
        np.atleast_1d(np.asarray(getattr(slide, name)))
        for name in ("eps", "mean_plus", "peak_plus", "mean_minus", "peak_minus")
    )
    codes = np.maximum(np.atleast_1d(slide.code_plus), np.atleast_1d(slide.code_minus))
    good = (codes == 0) & np.all(np.isfinite(forces), axis=0)
    require(good.any(), "slide", repr(slide), "one that was found")
    drawn, axes = axes_of(ax, 6.4, 4.2)
    order = np.flatnonzero(good)[np.argsort(eps[good])]
    sides = (("to the right", forces[:2]), ("to the left", forces[2:]))
    for index, (name, (mean, peak)) in enumerate(sides):
        look: dict[str, Any] = {"color": colour(index), "marker": "o", "label": name}
        axes.plot(eps[order], mean[order], **look)
        axes.vlines(eps[order], mean[order], peak[order], color=colour(index), lw=3)
    axes.axhline(0.0, color=GUIDE, linewidth=0.8)
    axes.set(xscale="log", xlabel="$\\epsilon$ (m)", ylabel="force (N)")
    lost = int(np.count_nonzero(~good))
    note = f"; {lost} of {eps.size} not found" if lost else ""
    axes.set_title(f"Steady slides: points are means, lines reach to the peaks{note}")
    axes.legend(loc="best")
    return drawn
