"""The scene whose limit is that of one with noise that vanishes."""

from .._checks import exchanged
from ..effects import Noise, noise_among
from ..model import Scene


def without_noise(scene: Scene) -> Scene:
    """A scene less its thermal noise; itself where it has none."""
    if noise_among(scene.effects) is None:
        return scene
    rest = tuple(e for e in scene.effects if not isinstance(e, Noise))
    return exchanged(scene, {"effects": rest})
