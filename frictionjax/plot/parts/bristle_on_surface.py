"""The bristle of a scene over its surface."""

from typing import Any

import jax.numpy as jnp
import numpy as np

from ..._checks import require
from ...bristles import AngularSpring, Stance
from ...model import Scene
from ..moving import coil
from ..style import LIMIT, STRIP, axes_of, colour, styled

_PERIOD = 0.22  # of the surface as drawn, in heights of the root
_POINTS = 1201


@styled
def draw_parts(scene: Scene, ax: Any = None) -> Any:
    """Draw the bristle and the support of a `scene` as they stand at first.

    Bumps are not to scale. Of a bristle without a geometry: a rod, upright and 1 m long. Of
    an array one of them. A Figure, or `ax` where it is drawn into that.

    Raises `ValueError` for a scene without a bristle.

    >>> figure = fx.plot.draw_parts(scene)
    >>> [text.get_text() for text in figure.axes[0].texts][1:]
    ['root, 1 m high', 'support, Spring', 'pulled, load l(t)', 'tip']
    """
    profile, bristle = scene.profile, scene.bristle
    needs = "a profile and a bristle: fx.friction(scene).plot() draws the potential's force"
    known = profile is not None and bristle is not None
    require(known, "scene", "one of a potential alone", needs)
    assert profile is not None
    assert bristle is not None
    drawn, axes = axes_of(ax, 7.2, 3.1)
    seen = bristle.geometry(jnp.zeros(()))
    stance = Stance(jnp.zeros(()), jnp.ones(())) if seen is None else seen
    angle, length = float(stance.angle), float(stance.length)
    height = length * np.cos(angle)
    root = np.array([length * np.sin(angle), height])
    left = min(-1.0, root[0] / height - 0.9) * height
    end = root + np.array([1.5 * height, 0.0])
    pulled = end + np.array([0.55 * height, 0.0])
    right = float(pulled[0]) + 0.35 * height
    _surface(axes, profile, height, left, right)
    tip = np.array([0.0, _PERIOD * height * float(profile(jnp.zeros(())))])
    rod = seen is None or isinstance(bristle, AngularSpring)
    _line(axes, tip, root, 0.1 * height, rod, colour(0), 2.2)
    axes.plot(*tip, "o", color=colour(1), markersize=6)
    axes.plot(*root, "s", color=LIMIT, markersize=8)
    _line(axes, root, end, 0.1 * height, False, LIMIT, 1.2)
    arrow = {"arrowstyle": "-|>", "color": colour(2), "linewidth": 2}
    axes.annotate("", pulled, end, arrowprops=arrow)
    _words(axes, scene, root, end, height, seen)
    axes.set_xlim(left, right)
    axes.set_ylim(-0.22 * height, 1.42 * height)
    axes.set_aspect("equal")
    axes.set_axis_off()
    return drawn


def _surface(axes: Any, profile: Any, height: float, left: float, right: float) -> None:
    x = np.linspace(left, right, _POINTS)
    w = np.asarray(profile(jnp.asarray(x / (_PERIOD * height))))
    low = _PERIOD * height * w
    axes.fill_between(x, low, -0.3 * height, color=STRIP, linewidth=0)
    axes.plot(x, low, color=LIMIT, linewidth=1.1)


def _line(axes: Any, a, b, wide: float, straight: bool, shade: Any, width: float) -> None:
    """A rod, or a spring, from one point to another."""
    points = np.stack([a, b], axis=1) if straight else coil(a, b, wide)
    axes.plot(*points, color=shade, linewidth=width, solid_joinstyle="round")


def _words(axes: Any, scene: Scene, root, end, height: float, known: Stance | None) -> None:
    dark = {"color": "#444444", "ha": "center", "fontsize": 9}
    kind = type(scene.bristle).__name__
    told = "root" if known is None else f"root, {height:.3g} m high"
    axes.annotate(told, root, (0, 9), textcoords="offset points", **dark)
    middle = 0.5 * (root + end)
    held = f"support, {type(scene.support).__name__}"
    axes.annotate(held, middle, (0, 14), textcoords="offset points", **dark)
    axes.annotate("pulled, load l(t)", end, (32, 9), textcoords="offset points", **dark)
    axes.annotate("tip", (0, 0), (-14, 10), textcoords="offset points", **dark)
    lean = "" if known is None else f", {float(known.angle):.3g} rad from the vertical"
    axes.set_title(f"{kind}{lean}; bumps of the surface not to scale")
