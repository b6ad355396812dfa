"""What pulls at a scene, and what holds it."""

import jax
import jax.numpy as jnp
import numpy as np
from matplotlib.figure import Figure

from ...model import Scene, composed, friction
from ..style import GUIDE, colour, new_figure, styled

_POINTS = 1201
_SMALL = 1e-6  # m: eps at which the force of a well is its limit's


@styled
def draw_forces(scene: Scene) -> Figure:
    r"""Draw the load of a `scene` over time, and the force of its surface over a period.

    The latter for eps -> 0, with `rho_plus` and `rho_minus`, where it is extreme.

    >>> figure = fx.plot.draw_forces(scene)
    >>> [text.get_text() for text in figure.axes[1].texts]
    ['$\\rho_+$ = 0.12 N', '$\\rho_-$ = -0.0879 N']
    """
    law = friction(scene)
    figure, grid = new_figure(1, 2, 9.6, 3.5)
    left, right = grid[0]
    t, load = _load_over_time(scene)
    left.plot(t, load, color=colour(2))
    left.set(xlabel="t (s)", ylabel="load $\\ell$ (N)", title="How it is pulled")
    left.margins(x=0)
    Y = np.linspace(0.0, 1.0, _POINTS)
    right.plot(Y, _well_force(scene, Y), color=colour(0))
    for name, value in (("\\rho_+", law.rho_plus), ("\\rho_-", law.rho_minus)):
        level = float(value)
        right.axhline(level, color=GUIDE, linewidth=1, linestyle="--")
        right.annotate(
            f"${name}$ = {level:.3g} N",
            (0.98, level),
            xycoords=right.get_yaxis_transform(),
            xytext=(0, 4 if level > 0 else -4),
            textcoords="offset points",
            ha="right",
            va="bottom" if level > 0 else "top",
            color="#444444",
        )
    right.set(xlabel="place Y (periods)", ylabel="force W'(Y) (N)")
    right.set_title("Force of the surface over one period")
    right.margins(x=0, y=0.14)
    return figure


def _load_over_time(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and loads (N) of the scene."""
    t = np.linspace(0.0, float(scene.duration), _POINTS)
    return t, np.asarray(jax.vmap(scene.load)(jnp.asarray(t)))


def _well_force(scene: Scene, Y: np.ndarray) -> np.ndarray:
    """`W'(Y)` in N, effects of the potential worked in."""
    potential = composed(scene).potential
    return np.asarray(potential.force(_SMALL * Y, _SMALL))
