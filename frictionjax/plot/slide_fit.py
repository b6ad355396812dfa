"""A bristle designed on its slides, beside what the limit says of its family."""

from typing import Any

import numpy as np

from .angle_fit import QUANTITY_LABELS, family_on
from .design_maps import number_label
from .style import GUIDE, LIMIT, axes_of, styled


@styled
def draw_slide_fit(fit: Any, ax: Any = None) -> Any:
    """Draw a `fit` of `fit_slide`: solutions at its eps over the limit's curve.

    A Figure, or `ax` where it is drawn into that.

    Filled: the bristle returned, at what its slide shows; hollow: other solutions. Its
    distance from the curve is what finite eps adds to the limit.

    >>> fit = fx.fit_slide(scene.profile, scene.bristle, eps=0.01, ratio=1.3)
    >>> figure = fx.plot.draw_slide_fit(fit)
    >>> figure.axes[0].get_legend_handles_labels()[1][1:]
    ['wanted: 1.3', 'other solutions', 'slide: angle = 0.93016']
    """
    drawn, axes = axes_of(ax, 6.4, 4.6)
    limit, target, value = fit.limit, float(fit.target), float(fit.value)
    reach = [target, float(fit.achieved)]
    family_on(axes, limit, reach, "limit, eps \N{RIGHTWARDS ARROW} 0")
    axes.axhline(target, color=GUIDE, linestyle="--", label=f"wanted: {target:.4g}")
    others = [v for v in np.asarray(fit.solutions) if v != value]
    look: dict[str, Any] = {"color": LIMIT, "linestyle": "none", "marker": "o", "zorder": 3}
    if others:
        hollow = look | {"markerfacecolor": "white"}
        axes.plot(others, [target] * len(others), **hollow, label="other solutions")
    told = f"{limit.free} = {value:.5g}"
    label = f"slide: {told}" if fit.success else f"slide, nearest: {told}"
    axes.plot([value], [float(fit.achieved)], **look, label=label)
    quantity = QUANTITY_LABELS[limit.quantity]
    axes.set(xlabel=number_label(limit.free), ylabel=quantity)
    eps = float(fit.slide.eps)
    axes.set_title(f"Design on {fit.force} forces of slides, $\\epsilon$ = {eps:.3g} m")
    axes.legend(loc="best")
    return drawn
