"""Feet and spring of a crawler over time."""

from typing import Any

import numpy as np

from ..._checks import kind_of, require
from ..style import GUIDE, axes_of, colour, styled


@styled
def draw_crawler(motion: Any, ax: Any = None) -> Any:
    """Draw places of both feet in m against t in s, of a `motion` by `crawler`.

    A Figure, or `ax` where it is drawn into that.

    Shaded: what is between the feet, which the spring pushes apart and pulls together;
    dashed: their middle. The title says how far it gets in a cycle.

    Raises `ValueError` for what is no such motion.

    >>> breathing = fx.loads.Sine(amplitude=0.5, period=1.0)
    >>> found = fx.crawler(scene.profile, scene.bristle, 1.0, breathing, duration=3.0)
    >>> figure = fx.plot.draw_crawler(found)
    >>> figure.axes[0].get_legend_handles_labels()[1]
    ['front foot', 'rear foot', 'middle']
    """
    known = hasattr(motion, "rear")
    require(known, "motion", kind_of(motion), "what crawler returns")
    drawn, axes = axes_of(ax, 7.2, 4.4)
    ts = np.asarray(motion.ts)
    axes.fill_between(ts, motion.rear, motion.front, color=colour(0), alpha=0.12, lw=0)
    axes.plot(ts, motion.front, color=colour(0), label="front foot")
    axes.plot(ts, motion.rear, color=colour(1), label="rear foot")
    axes.plot(ts, motion.position, color=GUIDE, linestyle="--", label="middle")
    axes.set(xlabel="t (s)", ylabel="place (m)", xlim=(ts[0], ts[-1]))
    axes.set_title(_title(motion))
    axes.legend(loc="best")
    return drawn


def _title(motion: Any) -> str:
    if not motion.ok:
        return motion.message
    if not np.isfinite(motion.step):
        return "Crawler"
    return f"Crawler: {motion.step:.3g} m a cycle"
