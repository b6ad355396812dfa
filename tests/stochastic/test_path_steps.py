import numpy as np
import pytest
from noisy_wells import COSINE

from frictionjax.stochastic.force_table import tabulated_force
from frictionjax.stochastic.path_steps import steps_of_paths

CELL = {"eps": 0.1, "viscosity": 2.0, "temperature": 1e-5, "duration": 3.0}


@pytest.fixture(scope="module")
def force():
    return tabulated_force(COSINE, 0.1)


def test_steps_are_a_share_of_the_relaxation_and_end_with_the_scene(force):
    found = steps_of_paths(force, 1.0, **CELL)
    assert found.total * found.step == pytest.approx(3.0, rel=1e-14)
    assert 0.048 < found.step * (1 + force.curvature) / 2.0 <= 0.05


def test_hot_tips_do_not_step_over_wells(force):
    found = steps_of_paths(force, 1.0, **(CELL | {"temperature": 1.0}))
    spread = np.sqrt(2 * 1.0 / 2.0 * found.step)
    assert 0.09 < spread / 0.1 <= 0.1000001


def test_too_many_steps_are_refused_with_their_eps(force):
    with pytest.raises(ValueError, match=r"eps = 0\.1: needs at most .* here 2\.\d+e\+11"):
        steps_of_paths(force, 1.0, **(CELL | {"duration": 3e9}))
