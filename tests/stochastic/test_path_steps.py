import numpy as np
import pytest
from noisy_wells import COSINE

from frictionjax.stochastic.force_table import tabulated_force
from frictionjax.stochastic.path_steps import path_steps

FORCE = tabulated_force(COSINE, 0.1)
CELL = {"eps": 0.1, "viscosity": 2.0, "temperature": 1e-5, "duration": 3.0}


def test_steps_are_a_share_of_the_relaxation_and_end_with_the_scene():
    found = path_steps(FORCE, 1.0, **CELL)
    assert found.count * found.step == pytest.approx(3.0, rel=1e-14)
    assert 0.24 < found.step * (1 + FORCE.curvature) / 2.0 <= 0.25


def test_hot_tips_do_not_step_over_wells():
    found = path_steps(FORCE, 1.0, **(CELL | {"temperature": 1.0}))
    spread = np.sqrt(2 * 1.0 / 2.0 * found.step)
    assert 0.04 < spread / 0.1 <= 0.05


def test_too_many_steps_are_refused_with_their_eps():
    with pytest.raises(ValueError, match=r"eps = 0\.1: needs at most .* here 4\.\d+e\+10"):
        path_steps(FORCE, 1.0, **(CELL | {"duration": 3e9}))
