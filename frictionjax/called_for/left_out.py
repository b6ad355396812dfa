"""The scene without effects that its accuracy does not call for."""

from itertools import product
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from .._checks import is_concrete, require
from ..effects import Stage
from ..model import Scene, known_scene
from .estimates import estimate_of
from .setting import setting_of

ALL, AUTO = "all", "auto"


class Simulated(NamedTuple):
    """A scene, and of what was left out of it the most that it changes, in eps, by name."""

    scene: Scene
    left_out: dict[str, float]

    @property
    def in_words(self) -> str:
        """What was left out; empty where nothing was."""
        return left_out_in_words(self.left_out)


def left_out_in_words(left_out: dict[str, Any]) -> str:
    """Effects that were left out, and the most that each changes, of a batch in any."""
    most = ((name, float(np.max(changes))) for name, changes in left_out.items())
    return ", ".join(f"{name} (at most {change:.2g} eps)" for name, change in most)


def simulated(scene: Any, effects: Any, eps: Any, gamma: Any, accuracy: Any) -> Simulated:
    """What is simulated of a scene: all its effects, or those that an accuracy calls for.

    `effects`: "all" or "auto". With "auto" effects are left out, those that matter least
    first, as long as together they change the state by at most `accuracy` eps at all times
    outside of slips, in each cell of eps (m) and gamma. Those of the potential stay, as
    they cost nothing, those that are read only, and those that no estimate is known of.

    Raises `ValueError` for other words, and for traced scenes with "auto".
    """
    require(effects in (ALL, AUTO), "effects", effects, f"{ALL!r} or {AUTO!r}")
    if effects == ALL:
        return Simulated(scene, {})
    scene = known_scene(scene)
    known = is_concrete(scene, eps, gamma, accuracy)
    require(known, "effects", effects, f"{ALL!r} where scenes or numbers are traced")
    small = _small_changes(scene, np.atleast_1d(eps), np.atleast_1d(gamma))
    left_out: dict[str, float] = {}
    for name, most in sorted(small.items(), key=lambda item: item[1]):
        if sum(left_out.values()) + most <= float(accuracy):
            left_out[name] = most
    kept = tuple(e for e in scene.effects if type(e).__name__ not in left_out)
    return Simulated(scene.replace(effects=kept) if left_out else scene, left_out)


def _small_changes(
    scene: Scene, eps: Float[np.ndarray, " e"], gamma: Float[np.ndarray, " g"]
) -> dict[str, float]:
    """Most that each effect of the state changes in any cell, in eps; NaN where unknown."""
    moving = [effect for effect in scene.effects if effect.stage == Stage.STATE]
    if not moving:
        return {}
    at = setting_of(scene, float(np.max(eps)), float(np.max(gamma)))  # laws are of all eps
    most = {type(effect).__name__: np.nan if at is None else 0.0 for effect in moving}
    if at is None:
        return most
    for size, power in product(eps.tolist(), gamma.tolist()):
        cell = at._replace(eps=size, gamma=power)
        for effect in moving:
            name, told = type(effect).__name__, estimate_of(effect, cell).in_z / size
            most[name] = float(np.maximum(most[name], told))  # NaN stays
    return most
