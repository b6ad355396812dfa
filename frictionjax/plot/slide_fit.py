"""A bristle designed on its slides, beside what the limit says of its family."""

from typing import Any

import numpy as np

from .angle_fit import QUANTITY_LABELS, family_on
from .design_maps import number_label
from .style import GUIDE, LIMIT, axes_of, label_eps, styled


@styled
def draw_slide_fit(fit: Any, ax: Any = None) -> Any:
    r"""Draw a `fit` of `fit_slide`: solutions at its eps over the limit's curve.

    A Figure, or `ax` where it is drawn into that.

    The line is of the limit alone. Filled: the bristle returned, at what its slide shows;
    hollow: other solutions, slides too. Their distance from the line is what finite eps
    adds to the limit.

    >>> fit = fx.fit_slide(scene.profile, scene.bristle, eps=0.01, ratio=1.3)
    >>> figure = fx.plot.draw_slide_fit(fit)
    >>> figure.axes[0].get_legend_handles_labels()[1][1:]
    ['wanted: 1.3', 'other solutions', 'slide, $\\epsilon$ = 0.01 m: angle = 0.93016']
    """
    drawn, axes = axes_of(ax, 6.4, 4.6)
    limit, target, value = fit.limit, float(fit.target), float(fit.value)
    reach = [target, float(fit.achieved)]
    family_on(axes, limit, reach, "limit, $\\epsilon \\to 0$")
    axes.axhline(target, color=GUIDE, linestyle="--", label=f"wanted: {target:.4g}")
    others = [v for v in np.asarray(fit.solutions) if v != value]
    look: dict[str, Any] = {"color": LIMIT, "linestyle": "none", "marker": "o", "zorder": 3}
    if others:
        hollow = look | {"markerfacecolor": "white"}
        axes.plot(others, [target] * len(others), **hollow, label="other solutions")
    eps = float(fit.slide.eps)
    nearest = "" if fit.success else ", nearest"
    label = f"slide, {label_eps(eps)}{nearest}: {limit.free} = {value:.5g}"
    axes.plot([value], [float(fit.achieved)], **look, label=label)
    quantity = QUANTITY_LABELS[limit.quantity]
    axes.set(xlabel=number_label(limit.free), ylabel=quantity)
    axes.set_title(f"Design on {fit.force} forces of slides, {label_eps(eps)}")
    axes.legend(loc="best")
    return drawn
