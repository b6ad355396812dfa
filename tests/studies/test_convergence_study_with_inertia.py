"""Studies of scenes with inertia: whether the limit is the paper's."""

import numpy as np
import pytest
from tips_with_mass import mass_for, massive_scene

import frictionjax as fx

EPS = np.geomspace(3e-2, 3e-3, 8)


def study_of(beta, exponent):
    """Of a mass with this beta at eps = 0.01, gamma = 1."""
    mass = mass_for(beta, 0.01, 1.0) / 0.01**exponent
    return fx.study(fx.sweep(massive_scene(mass, exponent), EPS, [1.0], [0.0, 3.0]))


@pytest.mark.slow  # 5 s
def test_a_mass_that_falls_faster_is_overdamped_in_the_limit():
    found = study_of(0.05, 4.0).orders.sel(gamma=1.0)
    assert float(found.inertia_order) == pytest.approx(1.0)
    assert int(found.overdamped) == 1
    assert "overdamped for eps -> 0" in found.attrs["inertia"]
    assert str(found.law.item()) == "free"
    assert float(found.order_seen) == pytest.approx(1.0, abs=0.15)


def test_a_mass_that_does_not_is_not_and_says_so():
    found = study_of(2.0, 2.0).orders.sel(gamma=1.0)
    assert float(found.inertia_order) == pytest.approx(-1.0)
    assert int(found.overdamped) == 0
    assert "gamma = 1: the mass does not fall faster" in found.attrs["inertia"]
    assert float(found.order_seen) < 0.1


def test_the_border_is_not_overdamped():
    found = study_of(1e-3, 3.0).orders.sel(gamma=1.0)
    assert float(found.inertia_order) == 0.0
    assert int(found.overdamped) == 0


def test_other_scenes_have_no_such_columns():
    plain = massive_scene(1.0).replace(effects=())
    found = fx.study(fx.sweep(plain, EPS[:3], [1.0], [0.0, 3.0])).orders
    assert "overdamped" not in found
    assert "inertia" not in found.attrs
