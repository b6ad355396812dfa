"""What a lane looks at along its way."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.tables import support_table
from frictionjax.wiggly.equation.field import Point
from frictionjax.wiggly.lanes.lane import LaneCells, LaneScene, _outside

RHO = 0.05, -0.05
EPS = 1e-3
# Soft where nothing pulls: three of Newton's steps from there end a way off.
SUPPORT = fx.supports.Convex(lambda z: 0.025 * z**2 + z**4 / 4)
TABLE = support_table(SUPPORT, -0.2, 0.2)
STATES_OF = jax.jit(SUPPORT.state_of)


@jax.jit
@partial(jax.vmap, in_axes=(0, 0, 0))
def outside(load, z, guide):
    scene = LaneScene(None, TABLE, None, *RHO)
    cell = LaneCells(EPS, EPS, *[jnp.ones(())] * 5)
    none = jnp.zeros(())
    point = Point(none, none, none, z, jnp.ones(()), load)
    return _outside(scene, cell, point, guide, none)[0]


@pytest.mark.parametrize("off", [-100.0, -2.0, -0.3, 0.3, 2.0, 100.0])
def test_how_far_a_tip_is_outside_is_told_by_the_edge_beside_it(off):
    loads = np.linspace(-0.1, 0.1, 41)
    lower, upper = (np.asarray(STATES_OF(loads - rho)) for rho in RHO)
    edge = upper if off > 0 else lower
    z = edge + off * EPS
    guides = np.stack([edge, 0.5 * (lower + upper)])  # sliding, and at rest
    found = [np.asarray(outside(loads, z, guide)) for guide in guides]
    np.testing.assert_allclose(found, np.full((2, 41), abs(off) * EPS), rtol=1e-6)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.7, 1.0])
def test_a_tip_in_the_strip_is_never_told_to_be_outside(share):
    """The edge further off, of a support that is twenty times as stiff there, was found a
    way off: suprema were up to four times what tips ever left the strip by."""
    loads = np.linspace(-0.12, 0.12, 97)
    lower, upper = (np.asarray(STATES_OF(loads - rho)) for rho in RHO)
    guide = lower + share * (upper - lower)
    for tip in np.linspace(0.0, 1.0, 21):
        found = np.asarray(outside(loads, lower + tip * (upper - lower), guide))
        assert np.max(found) < 1e-12
