"""Which loop compiles beside the planning: a guess, by how many values are asked for."""

import numpy as np
import pytest
from samples import swinging_scene

from frictionjax.model import tabulated_scene
from frictionjax.wiggly import batch
from frictionjax.wiggly.plan import lane_scene


@pytest.mark.parametrize(
    ("cells", "times", "begun"),
    [(1, 2, [True]), (4, 25, [True]), (1, 201, []), (3, 201, [False])],
)
def test_few_values_have_the_narrow_loop_compiled(monkeypatch, cells, times, begun):
    """In between either may be it: a wrong guess is 9 s of a core."""
    narrow = []
    monkeypatch.setattr(
        batch, "prepare", lambda *_, narrow=False, to=narrow: to.append(narrow)
    )
    lanes = lane_scene(tabulated_scene(swinging_scene(0.1), np.array([0.01])))
    batch._prepare(lanes, cells, times, True)
    assert narrow == begun
