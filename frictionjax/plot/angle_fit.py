"""The quantity that a bristle was designed for, over the number that was free."""

from typing import Any

import numpy as np

from .._checks import require
from .design_maps import number_label
from .style import GUIDE, LIMIT, axes_of, colour, styled

QUANTITY_LABELS = {
    "ratio": "friction ratio $-\\rho_+/\\rho_-$ (1)",
    "rho_plus": "friction to the right $\\rho_+$ (N)",
    "rho_minus": "friction to the left $\\rho_-$ (N)",
    "difference": "difference $\\rho_+ + \\rho_-$ (N)",
}
_NO_FORCE = 1e-3  # of the largest alpha, a millionth of the interval from its end
_ABOVE = 4.0  # times the target, and the middle of the curve: poles go on out of sight


@styled
def draw_angle_fit(fit: Any, ax: Any = None) -> Any:
    """Draw a `fit_angle`: the quantity over all admissible values, target and solutions.

    One line for each admissible interval; where one ends as alpha does, a line says so,
    elsewhere bounds end it, or nothing is admissible. Filled: the bristle returned; hollow:
    the other solutions. A Figure, or `ax` where it is drawn into that.

    Raises `ValueError` for a batch: pick one with `fit[i]`.

    >>> fit = fx.fit_angle(scene.profile, scene.bristle, ratio=1.5)
    >>> fx.plot.draw_angle_fit(fit).axes[0].get_legend_handles_labels()[1]
    ['admissible bristles', 'wanted: 1.5', 'angle = 1.1071']
    """
    require(np.ndim(fit.code) == 0, "fit", f"{np.size(fit.code)} fits", "one: fit[i]")
    drawn, axes = axes_of(ax, 6.4, 4.6)
    target = float(fit.target)
    family_on(axes, fit, [target], "admissible bristles")
    _ends_on(axes, fit)
    axes.axhline(target, color=GUIDE, linestyle="--", label=f"wanted: {target:.4g}")
    others = [v for v in np.asarray(fit.solutions) if v != float(fit.value)]
    look: dict[str, Any] = {"color": LIMIT, "linestyle": "none", "marker": "o", "zorder": 3}
    if others:
        hollow = look | {"markerfacecolor": "white"}
        axes.plot(others, [target] * len(others), **hollow, label="other solutions")
    value = f"{fit.free} = {float(fit.value):.5g}"
    told = value if fit.success else f"nearest: {value}"
    axes.plot([float(fit.value)], [float(fit.achieved)], **look, label=told)
    axes.set(xlabel=number_label(fit.free), ylabel=QUANTITY_LABELS[fit.quantity])
    axes.set_title("Inverse design of the bristle")
    axes.legend(loc="best")
    return drawn


def _ends_on(axes: Any, fit: Any) -> None:
    """Lines where the bristle no longer presses, or pulls: alpha = 0."""
    forces = np.abs(np.asarray(fit.normal_forces(3)))  # at both ends and between
    none = forces[:, ::2] < _NO_FORCE * forces.max(axis=1, keepdims=True)
    for number in np.unique(np.asarray(fit.admissible)[none]):
        axes.axvline(number, color=GUIDE, linewidth=0.9, linestyle="--", zorder=1)
        axes.annotate(
            "$\\alpha$ = 0",
            (number, 0.5),
            xycoords=axes.get_xaxis_transform(),
            xytext=(-3, 0),
            textcoords="offset points",
            rotation=90,
            ha="right",
            va="center",
            color="#666666",
        )


def family_on(axes: Any, fit: Any, shown: list[float], label: str) -> None:
    """The quantity of all admissible bristles, in a window that holds what is `shown`."""
    numbers, quantities = (np.asarray(part) for part in fit.curve())
    there = ~np.isnan(numbers[:, 0])
    curves = list(zip(numbers[there], quantities[there], strict=True))
    for index, (x, y) in enumerate(curves):
        axes.plot(x, y, color=colour(0), label=label if index == 0 else None)
    if fit.free in ("stiffness", "rest_length", "height") and numbers[there].min() > 0:
        axes.set_xscale("log")
    windows = [_window(quantities[there], one) for one in shown]
    axes.set_ylim(min(low for low, _ in windows), max(high for _, high in windows))


def _window(quantities: np.ndarray, target: float) -> tuple[float, float]:
    """Range of the axis: the target and the middle of the curves, not their poles."""
    low, high = np.percentile(quantities, (10, 90))
    size = max(abs(target), abs(low), abs(high))
    bottom = max(float(np.min(quantities)), -_ABOVE * size, min(low - size, target - size))
    top = min(float(np.max(quantities)), _ABOVE * size, max(high + size, target + size))
    bottom, top = min(bottom, target), max(top, target)
    room = 0.06 * (top - bottom)
    return bottom - room, top + room
