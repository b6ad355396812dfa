"""Paths of scenes, for tests that ask for nothing else of their tables."""

import frictionjax as fx
from frictionjax.model import tabulated_scene
from frictionjax.wiggly import limit_path


def path_of(scene: fx.Scene) -> limit_path.Path | None:
    """The path that the strip's edges prescribe, whatever the eps."""
    return limit_path.path_of(tabulated_scene(scene, 0.1))
