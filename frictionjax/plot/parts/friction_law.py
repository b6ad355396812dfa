"""Friction as the principle sees it: K over |xi|, and where M meets the power."""

from typing import Any

import numpy as np

from ..._checks import kind_of, require
from ...model import Scene, coefficients_jit
from ...principle import K
from ..style import GUIDE, LIMIT, STRIP, colour, new_figure, styled

_BEYOND = 0.4  # of the interval of friction, on both sides
_FORCES = 241


@styled
def draw_friction_law(scene: Scene) -> Any:
    """Draw what friction of a `scene` takes at least, and the motions that it allows.

    A Figure. Left: `K(xi)` in N over the force xi (eq. 5.4), above |xi| inside the interval
    of friction, which is shaded, and |xi| outside. Right: the graph C_M of friction
    (eq. 5.5), velocities over forces: no motion inside, any at its ends.

    Raises `ValueError` for what is no scene.

    >>> figure = fx.plot.draw_friction_law(scene)
    >>> [axes.get_title(loc="left") for axes in figure.axes]
    ['What friction takes of each metre', 'What friction allows']
    """
    require(isinstance(scene, Scene), "scene", kind_of(scene), "a Scene")
    law = coefficients_jit(scene.potential)
    low, high = float(law.rho_minus), float(law.rho_plus)
    wide = high - low
    xi = np.linspace(low - _BEYOND * wide, high + _BEYOND * wide, _FORCES)
    drawn, grid = new_figure(1, 2, 10.0, 4.0)
    _resistance(grid[0, 0], scene, xi, (low, high))
    _graph(grid[0, 1], xi, (low, high))
    return drawn


def _resistance(axes: Any, scene: Scene, xi: np.ndarray, ends: tuple[float, float]) -> None:
    axes.axvspan(*ends, color=STRIP, zorder=0)
    axes.plot(xi, np.asarray(K(scene, xi)), color=colour(0), label="K")
    axes.plot(xi, np.abs(xi), color=LIMIT, linestyle="--", label="|force|")
    axes.set(xlabel="force xi in N", ylabel="K in N", xlim=(xi[0], xi[-1]))
    axes.set_ylim(bottom=0.0)
    axes.set_title("What friction takes of each metre")
    axes.legend(loc="best")


def _graph(axes: Any, xi: np.ndarray, ends: tuple[float, float]) -> None:
    low, high = ends
    axes.axvspan(*ends, color=STRIP, zorder=0)
    axes.axhline(0.0, color=GUIDE, linewidth=0.8)
    axes.plot([low, low, high, high], [-1.0, 0.0, 0.0, 1.0], color=colour(1), linewidth=2.2)
    for end, side in ((low, "right"), (high, "left")):
        shift = -6 if side == "right" else 6
        told = f"{end:.3g} N"
        axes.annotate(told, (end, 0.0), (shift, 6), textcoords="offset points", ha=side)
    axes.set(xlabel="force xi in N", ylabel="velocity", xlim=(xi[0], xi[-1]), ylim=(-1, 1))
    axes.set_yticks([0.0])
    axes.set_title("What friction allows")
