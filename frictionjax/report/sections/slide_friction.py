"""What friction a scene's slides have, and under which condition, in words."""

import jax.numpy as jnp

from ...coefficients import Coefficients, Condition, condition_of, note_condition
from ...effects import nap_flip_among
from ...model import Scene, friction
from ...turning import flipping_rod

_TURNED = Condition("once the rod has turned over")


def friction_of_slides(scene: Scene) -> Coefficients:
    """Of slides in the limit: a rod that turns over goes with its nap both ways."""
    effect = nap_flip_among(scene.effects)
    if effect is None:
        return friction(scene)
    rod = flipping_rod(scene, effect)
    both = rod.standing.rho_with, -rod.turned.rho_with
    found = Coefficients(*map(jnp.asarray, both))
    note_condition(found, _TURNED)
    return found


def under_condition(law: Coefficients) -> str:
    """What coefficients leave out, to stand after a number; empty where nothing."""
    condition = condition_of(law)
    return "" if condition is None else f" {condition.words}"


def friction_sentence(law: Coefficients, more: str = "") -> str:
    """Friction both ways and its ratio; `more`: what it leaves out beyond `law`'s own."""
    right, left = float(law.rho_plus), -float(law.rho_minus)
    ratio = right / left if left else float("nan")
    return (
        f"Friction becomes {right:.4g} N to the right and {left:.4g} N to the "
        f"left{under_condition(law)}{more}: {ratio:.4g} to 1."
    )
