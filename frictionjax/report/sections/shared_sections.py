"""What was computed: the scene drawn, its equation, its numbers, its friction."""

import jax
import jax.numpy as jnp
import numpy as np

from ... import plot
from ..._text import ResultTable
from ...coefficients import Coefficients
from ...explain import composed_equation
from ...io import part_rows
from ...model import Scene
from ..page import Captioned, Html, Section, equation, paragraph, shown, table_region
from .slide_friction import under_condition

_TIMES = 1201
_EQUATION = (
    "`z` is the state, in m: how far the root of the bristle has come. Viscosity eps^gamma "
    "times its speed is what is left of the load l(t) once the support, Phi', and the "
    "surface, V_eps', have pulled back. On small bumps the bristle waits in a hollow until "
    "the load is large enough, and then slips into the next one: that is what becomes dry "
    "friction as eps -> 0."
)
_GEOMETRY = (
    "`w` is the height of the surface at the place `y` of the tip, both in periods. `F` is "
    "the bristle's energy in J and `A` by how many m its root is ahead of where it stands "
    "on level ground, each for the height of the surface under the tip."
)


def scene_sentence(scene: Scene) -> str:
    """The scene's parts in a sentence."""
    names = [type(part).__name__ for part in (scene.bristle, scene.profile, scene.load)]
    effects = [type(effect).__name__ for effect in scene.effects]
    with_them = f", with {', '.join(effects)}" if effects else ""
    return (
        f"A bristle ({names[0]}) on a bumpy surface ({names[1]}), held by a spring and "
        f"pulled by a load ({names[2]}) for {float(scene.duration):.4g} s{with_them}."
    )


def scene_section(scene: Scene, law: Coefficients, eps: float, gamma: float) -> Section:
    """Drawn, as an equation, and in numbers; the equation at one eps (m) and gamma."""
    text = composed_equation(scene, eps, gamma).text()
    forces = f"{_FORCES}{under_condition(law)}."
    blocks: list[Html] = [
        paragraph(scene_sentence(scene)),
        shown(Captioned(plot.draw_parts(scene), _parts_told(scene), _PARTS), "the scene"),
        equation(text),
        paragraph(f"{_EQUATION} {_GEOMETRY}" if "A(eps w(y))" in text else _EQUATION),
        shown(
            Captioned(plot.draw_forces(scene), _forces_told(scene, law), forces), "forces"
        ),
        table_region(part_rows(scene), "Numbers of the scene"),
    ]
    return Section("The scene", blocks)


_PARTS = (
    "The bristle as it stands before anything moves. The tip feels the bumps, the root is "
    "pulled through the support's spring; positive is to the right."
)
_FORCES = (
    "Left: the load over time. Right: the force with which the surface holds the bristle, "
    "over one bump, for eps -> 0. Its largest and its smallest value are what friction "
    "becomes, `rho_plus` to the right and `rho_minus` to the left"
)


def _parts_told(scene: Scene) -> str:
    bristle = scene.bristle
    assert bristle is not None
    stance = bristle.geometry(jnp.zeros(()))
    name = type(bristle).__name__
    if stance is None:
        return (
            f"Drawing of the scene. The bristle, {name}, has no geometry of its own and is "
            "drawn upright; its root is held by a spring that is pulled to the right."
        )
    angle, length = float(stance.angle), float(stance.length)
    return (
        f"Drawing of the scene. The bristle, {name}, is {length:.4g} m long and stands "
        f"{angle:.4g} rad ({np.degrees(angle):.3g} degrees) from the vertical, its root "
        f"{length * np.cos(angle):.4g} m above the surface. The root is held by a "
        "horizontal spring whose other end is pulled to the right."
    )


def _forces_told(scene: Scene, law: Coefficients) -> str:
    times = jnp.linspace(0.0, scene.duration, _TIMES)
    load = np.asarray(jax.vmap(scene.load)(times))
    return (
        f"Two graphs. The load goes from {load[0]:.4g} N at the start to {load[-1]:.4g} N "
        f"after {float(scene.duration):.4g} s, and lies between {load.min():.4g} and "
        f"{load.max():.4g} N. The force of the surface over one period lies between "
        f"{float(law.rho_minus):.4g} N, rho_minus, and {float(law.rho_plus):.4g} N, "
        "rho_plus."
    )


def coefficient_section(law: Coefficients, table: ResultTable, more: str = "") -> Section:
    """Friction in each direction, in words and as a table; `more` to be said.

    `law`: of slides, which need not be that of the table, which says its own condition.
    """
    right, left = float(law.rho_plus), -float(law.rho_minus)
    said = (
        f"Pulled slowly to the right the bristle holds against {right:.4g} N, pulled to "
        f"the left against {left:.4g} N{under_condition(law)}"
    )
    if left:
        said += f": {right / left:.4g} times as much to the right as to the left"
    blocks = [paragraph(f"{said}. {_COEFFICIENTS}")]
    blocks += [paragraph(more)] if more else []
    return Section("Friction", [*blocks, table_region(table, "Friction coefficients")])


_COEFFICIENTS = (
    "These are the numbers of dry friction for eps -> 0: they do not depend on the speed. "
    "Signs: `rho_plus` is positive and `rho_minus` negative, friction against motion to "
    "the right and to the left."
)
