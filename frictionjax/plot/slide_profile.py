"""A surface designed on the dynamics, beside the one that its limit alone would give."""

from typing import Any

import numpy as np

from .design import against, drawn_series
from .style import LIMIT, colour, marker, new_figure, styled


@styled
def draw_slide_profile_fit(fit: Any, figure: Any = None) -> Any:
    """Draw the result of `fit_slide_profile`, `fit`.

    Heights and slopes of the surface, and dashed those of the limit design for the same
    targets, whose slides miss them; how far each design's slides were from the forces
    that it was made for; forces of the slides against the targets.
    `figure`: a matplotlib Figure or SubFigure to draw into, which is returned.

    >>> wanted = fx.Target(scene.bristle, rho_plus=0.12, rho_minus=-0.05)
    >>> figure = fx.plot.draw_slide_profile_fit(fx.fit_slide_profile(wanted, eps=0.01))
    >>> [axes.get_xlabel() for axes in figure.axes]
    ['y (periods)', 'y (periods)', 'design', '|force| wanted (N)']
    """
    drawn, grid = new_figure(2, 2, 10.0, 7.2, figure)
    _surfaces(grid[0, 0], fit, 0, "height w (periods)", "Surface")
    _surfaces(grid[0, 1], fit, 1, "slope w' (1)", "Slopes")
    _history(grid[1, 0], fit)
    _forces(grid[1, 1], fit)
    eps = float(fit.slides[0].eps)
    sentence = fit.status.name.replace("_", " ").lower()
    sentence += f"; {fit.force} forces of steady slides at eps = {eps:.4g} m"
    drawn.suptitle(sentence, x=0.01, ha="left", fontsize=11)
    return drawn


def _surfaces(axes: Any, fit: Any, order: int, label: str, title: str) -> None:
    axes.plot(
        *drawn_series(fit.profile, order), color=colour(0), linewidth=2, label="its slides"
    )
    limit = {"color": LIMIT, "linestyle": "--", "linewidth": 1}
    axes.plot(*drawn_series(fit.limit.profile, order), **limit, label="limit only")
    axes.set(xlabel="y (periods)", ylabel=label)
    axes.set_title(title)
    axes.margins(x=0)
    if order == 0:
        axes.legend(loc="upper left", title="made for the targets by")


def _history(axes: Any, fit: Any) -> None:
    designs = np.arange(1, fit.history.size + 1)
    axes.semilogy(designs, fit.history, color=colour(0), marker=marker(0))
    axes.set(xlabel="design", ylabel="largest relative gap (1)")
    axes.set_xticks(designs[:: 1 + designs.size // 12])
    axes.set_title("Forces of slides against those designed for")


def _forces(axes: Any, fit: Any) -> None:
    worst = np.max(np.abs(fit.residuals), axis=0)
    sides = zip(("to the right", "to the left"), worst, strict=True)
    labels = [f"{side}, worst {off:.1g} off" for side, off in sides]
    against(axes, fit.targets, fit.achieved, labels)
    axes.set(xlabel="|force| wanted (N)", ylabel="|force| of the slide (N)")
    axes.set_title("Forces")
    axes.legend(loc="upper left")
