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
    draw_well(right, composed(scene).potential, law)
    right.set_title("Force of the surface over one period")
    return figure


def _load_over_time(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and loads (N) of the scene."""
    t = np.linspace(0.0, float(scene.duration), _POINTS)
    return t, np.asarray(jax.vmap(scene.load)(jnp.asarray(t)))
