"""Where the tip of a straight rod is when its compression is the critical load."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from rods_that_turn import REACH, ROD, SURFACE, turning_scene

from frictionjax.certificate.critical_places import Beside, RodSide
from frictionjax.turning import SceneParts, compression, flipping_rod

EPS = 0.03
SCENE = turning_scene()
LAW = flipping_rod(SCENE, SCENE.effects[0])
PARTS = SceneParts(
    profile=SURFACE,
    rod=ROD,
    support=SCENE.support,
    load=SCENE.load,
    reach=jnp.asarray(LAW.reach),
    critical=jnp.asarray(LAW.critical),
)
sides = pytest.mark.parametrize("side", [1, -1])


def places_of(side):
    seen = RodSide.of(PARTS, side, EPS)
    return seen.force, seen.places


def compressions(force, y):
    pressed = jax.jit(jax.vmap(lambda one: compression(force.potential, one, force.eps)))
    return np.asarray(pressed(y))


@sides
def test_there_the_compression_is_critical_and_grows_against_the_nap(side):
    force, places = places_of(side)
    assert places.place.size == 1
    y = np.concatenate([places.place, places.place - 1e-3, places.relieved])
    found = compressions(force, y) / LAW.critical - 1
    np.testing.assert_allclose(found[[0, 2]], 0.0, atol=1e-11)
    assert found[1] > 1e-3
    assert 0 < places.place[0] - places.relieved[0] < 1


@sides
def test_there_the_bent_rod_pulls_as_the_straight_one(side):
    """Forces go on when the rod begins to bend: its thrust is the critical load."""
    _, places = places_of(side)
    low = EPS * float(SURFACE(side * places.place[0]))
    rod = LAW.bent._replace(height=LAW.bent.height - low)
    bent = side * float(jax.jit(rod.force)(side * rod.reach))
    assert bent == pytest.approx(places.pull[0], rel=1e-9)


def test_tips_are_beside_the_place_that_they_come_to():
    _, places = places_of(1)
    place, relieved = places.place[0], places.relieved[0]
    y = np.array([place + 0.1, place - 1e-6, relieved + 1e-6, relieved - 1e-6])
    for well in (0.0, 3.0):
        near = places.beside(np.full(4, well), y)
        np.testing.assert_array_equal(near.well, well + np.array([0, 0, 0, -1]))
        np.testing.assert_array_equal(near.past, [False, True, True, False])


def test_overloads_are_shares_of_the_critical_load():
    """From compressions of tips at rest beside the place, by bisection."""
    force, places = places_of(1)
    near = Beside(*(np.array(v) for v in ([0.0], [0], [False])))
    ts = np.array([1.2])
    (over,) = RodSide.of(PARTS, 1, EPS).overloads(1e-9, near, ts)
    load = float(SCENE.load(1.2))
    at_rest = float(force.state(0.0, places.place[0])) + float(places.pull[0])
    # A load as much larger than the tip needs there, over what it changes with the share.
    y = places.place + np.array([-1e-5, 1e-5])
    pulls = [float(force.pull(jnp.asarray(one))[0]) for one in y]
    change = np.diff(pulls)[0] / np.diff(compressions(force, y))[0]
    assert over == pytest.approx((at_rest - load) / abs(change * LAW.critical), rel=1e-6)
    assert LAW.reach == REACH
