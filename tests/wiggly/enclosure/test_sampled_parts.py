"""What is left of the path's way outside the parts of slides that are sampled."""

import numpy as np
import pytest
from paths import path_of

import frictionjax as fx
from frictionjax.wiggly.enclosure import CellSlides, wells_outside
from frictionjax.wiggly.enclosure.sampled_parts import Parts


def test_wells_outside_inner_parts_are_those_of_the_rest_of_the_way():
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(2.0),
        fx.loads.PiecewiseLinear([0.0, 1.0, 2.0], [0.0, 1.0, -1.0]),
        2.0,
    )
    path = path_of(scene)
    low, high = np.array([0.6, 1.6, 0.7]), np.array([0.8, 1.9, 0.8])
    none = np.zeros(3, dtype=int)
    cell = np.array([0, 0, 2])
    parts = Parts(cell, none, none, none, low, high, none, none)
    eps = np.array([1e-2, 1e-3, 1e-4])
    found = wells_outside(CellSlides(path, eps, None, None), parts)
    # Of 1 N and 2 N a second on 2 N/m.
    inside = np.array([0.2 / 2 + 0.3 * 2 / 2, 0.0, 0.1 / 2])
    assert found == pytest.approx((path.travel[-1] - inside) / eps)
