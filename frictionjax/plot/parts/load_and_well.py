"""What pulls at a scene, and what holds it."""

import jax
import jax.numpy as jnp
import numpy as np
from matplotlib.figure import Figure

from ...model import Scene, composed, friction
from ..style import colour, new_figure, styled
from .well import draw_well

_POINTS = 1201


@styled
def draw_forces(scene: Scene) -> Figure:
    """Draw the load over time, and the force of the surface over one of its periods.

    The latter for eps -> 0, with `rho_plus` and `rho_minus`, where it is extreme.
    """
    law = friction(scene)
    figure, grid = new_figure(1, 2, 9.6, 3.5)
    left, right = grid[0]
    t, load = _load_over_time(scene)
    left.plot(t, load, color=colour(2))
    left.set(xlabel="t (s)", ylabel="load $\\ell$ (N)", title="How it is pulled")
    left.margins(x=0)
    draw_well(right, composed(scene).potential, law)
    right.set_title("Force of the surface over one period")
    return figure


def _load_over_time(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and loads (N) of the scene."""
    t = np.linspace(0.0, float(scene.duration), _POINTS)
    return t, np.asarray(jax.vmap(scene.load)(jnp.asarray(t)))
