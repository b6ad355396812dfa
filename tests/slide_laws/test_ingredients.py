"""What laws need of a scene: forces of wells, speeds of the limit."""

import jax.numpy as jnp
import numpy as np
import pytest
from slides import known, scene

import frictionjax as fx
from frictionjax.slide_laws import SlideData


def test_the_change_of_the_largest_force_is_that_of_the_potential():
    """Q' of a slanted spring at the place of the largest force, from `fx.potential`."""
    found = known(scene(), np.array([0.01]))
    top = int(np.argmax(found.force))
    wiggle = scene().potential
    assert found.force[top] == pytest.approx(float(fx.friction(scene()).rho_plus), rel=1e-9)
    step = 1e-5
    ends = wiggle.Q(0.0, found.phase[top] + step * jnp.array([-1.0, 1.0]))
    assert found.change[top] == pytest.approx(
        float(ends[1] - ends[0]) / (2 * step), abs=1e-5
    )


def test_speeds_are_those_of_the_limit():
    one = scene()
    found = known(one, np.array([0.01]))
    ends = np.concatenate([[0.0], np.cumsum(found.length)])
    z = np.asarray(fx.solve_limit(one, np.minimum(ends, 3.0)).z)
    whole = np.flatnonzero(found.speed[1:-1] * found.speed[2:] * found.speed[:-2])[1:-1] + 1
    assert np.diff(z)[whole] == pytest.approx((found.speed * found.length)[whole], rel=1e-6)
    assert found.stiffness == pytest.approx(1.0, rel=1e-9)


def test_a_sweep_without_suprema_has_no_data_for_laws():
    bare = fx.sweep(scene(), [0.05], [1.0], ts=[0.0, 3.0], dissipation=False, suprema=False)
    assert SlideData.of(bare.attrs) is None
