"""The force of a potential over one of its periods, and the friction that it makes."""

from typing import Any

import numpy as np

from ..._checks import origin_of, require
from ...coefficients import Coefficients
from ...model import AbstractPotential
from ..style import GUIDE, axes_of, colour, styled

_POINTS = 1201
_SMALL = 1e-6  # m: eps at which the force of a well is its limit's


@styled
def draw_coefficients(found: Coefficients, ax: Any = None) -> Any:
    r"""Draw the force W'(Y) of which `friction` has `found` the extremes.

    A Figure, or `ax` where it is drawn into that.

    Over one period, for eps -> 0, with `rho_plus` and `rho_minus`, where it is extreme.

    Raises `ValueError` for coefficients that `friction` has not returned, or made of their
    leaves: nothing is known of their potential; and for a batch.

    >>> figure = fx.plot.draw_coefficients(fx.friction(scene))
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['$\\rho_+$ = 0.12 N', '$\\rho_-$ = -0.0879 N']
    """
    potential = origin_of(found)
    needs = "those that fx.friction has returned, of one scene"
    require(potential is not None, "coefficients", found, needs)
    drawn, axes = axes_of(ax, 5.6, 3.6)
    draw_well(axes, potential, found)
    ratio = -float(found.rho_plus) / float(found.rho_minus)
    axes.set_title(f"Force of the surface; $-\\rho_+/\\rho_-$ = {ratio:.4g}")
    return drawn


def draw_well(axes: Any, potential: AbstractPotential, law: Coefficients) -> None:
    """`W'(Y)` in N over one period, for eps -> 0, and its extremes, as levels."""
    Y = np.linspace(0.0, 1.0, _POINTS)
    force = np.asarray(potential.force(_SMALL * Y, _SMALL))
    axes.plot(Y, force, color=colour(0))
    for name, value in (("\\rho_+", law.rho_plus), ("\\rho_-", law.rho_minus)):
        level = float(value)
        axes.axhline(level, color=GUIDE, linewidth=1, linestyle="--")
        axes.annotate(
            f"${name}$ = {level:.3g} N",
            (0.98, level),
            xycoords=axes.get_yaxis_transform(),
            xytext=(0, 4 if level > 0 else -4),
            textcoords="offset points",
            ha="right",
            va="bottom" if level > 0 else "top",
            color="#444444",
        )
    axes.set(xlabel="place Y (periods)", ylabel="force W'(Y) (N)")
    axes.margins(x=0, y=0.14)
