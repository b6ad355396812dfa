"""What brackets are told of slides before anything runs."""

import numpy as np
import pytest
from flat_folds import SCENES
from paths import path_of

from frictionjax._checks import viscosity_of
from frictionjax.model import tabulated_scene
from frictionjax.wiggly.enclosure import SETTINGS
from frictionjax.wiggly.plan import planned
from frictionjax.wiggly.slip_map import steady_lags


@pytest.mark.parametrize("name", SCENES)
def test_lags_of_slower_slides_are_bounded(name):
    """Brackets set off behind tips on slow parts of slides too."""
    eps, gamma = np.array([1e-4, 1e-6, 1e-8]), np.array([0.4, 0.4, 0.5])
    scene = tabulated_scene(SCENES[name], eps)
    path = path_of(SCENES[name])
    plan = planned(scene, path, eps, gamma, 3, 1e-3, "auto")
    ground, drag = plan.ground, path.speed * viscosity_of(eps, gamma)
    for share in (0.5, 0.2, 0.1, 0.05):
        slower = steady_lags(scene.potential, eps, plan.control.folds, share * drag)
        for side, direction in zip(slower.force, (1, -1), strict=True):
            power = ground.power(np.arange(3), np.full(3, direction))
            fastest = ground.lag_plus if direction > 0 else ground.lag_minus
            bound = SETTINGS.faster * share**power * fastest
            assert np.all(side / path.stiffness <= bound), (share, direction)
