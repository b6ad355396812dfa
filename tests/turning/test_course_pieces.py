"""The limit of a rod that turns over, piece by piece."""

from itertools import pairwise

import numpy as np
import pytest
from rods_that_turn import REACH, jumping_scene, turning_scene

import frictionjax as fx
from frictionjax.turning import limit_course


def course_of(scene):
    return limit_course(scene, scene.effects[0])


@pytest.mark.parametrize("scene", [turning_scene(), jumping_scene()], ids=["led", "jumps"])
def test_pieces_hang_together(scene):
    pieces = [piece for some in course_of(scene).stretches for piece in some]
    assert {piece.mode for piece in pieces} == {1, 0, -1}
    for one, other in pairwise(pieces):
        assert one.until == pytest.approx(other.load, abs=1e-12)
        assert one.last == pytest.approx(other.z, abs=1e-12)
        assert one.spent == pytest.approx(other.lost, abs=1e-12)


def test_jumps_are_where_the_state_does_not_follow():
    course = course_of(jumping_scene())
    jumps = course.jumps()
    assert jumps.time.size == 2
    lost = np.asarray(fx.solve_limit(jumping_scene()).dissipation)[-1]
    assert 0 < np.sum(jumps.spent - jumps.lost) < lost
    for time, z, last in zip(jumps.time, jumps.z, jumps.last, strict=True):
        before, after = course.at(np.array([time - 1e-9, time + 1e-9])).z
        assert before == pytest.approx(z, abs=1e-3)  # as a root in time, at a fold
        assert after == pytest.approx(last, abs=1e-3)
        assert abs(last - z) > 0.5
        near = course.at(np.array([time - 1e-3, time - 1e-9])).z
        assert abs(near[1] - near[0]) < 0.2
    assert course_of(turning_scene()).jumps().time.size == 0


def test_changes_are_where_modes_change():
    scene = turning_scene()
    course = course_of(scene)
    ts = np.linspace(0, 4, 4001)
    mode = course.at(ts).mode
    for index in np.flatnonzero(np.diff(mode)):
        changes = course.changes()
        assert np.any((changes >= ts[index] - 1e-9) & (changes <= ts[index + 1] + 1e-9))


def test_tips_stay_where_the_root_goes_over_them():
    ts = np.linspace(0, 4, 801)
    found = course_of(turning_scene()).at(ts)
    between = found.mode == 0
    both = between[1:] & between[:-1]
    assert np.max(np.abs(np.diff(found.tip)[both])) < 1e-12
    assert np.max(np.abs(np.diff(found.tip))) < 2.5 / 200 + 1e-9
    ahead = found.root - found.tip
    np.testing.assert_allclose(ahead[~between], found.mode[~between] * REACH, atol=1e-12)


def test_the_strip_is_what_a_rod_withstands_in_its_mode():
    scene = turning_scene()
    course, ts = course_of(scene), np.linspace(0, 4, 401)
    found = course.at(ts)
    low, high = course.strip(ts, found.mode)
    stands = found.mode != 0
    assert np.all(np.isnan(low[~stands]) & np.isnan(high[~stands]))
    assert np.all(low[stands] - 1e-9 <= found.z[stands])
    assert np.all(found.z[stands] <= high[stands] + 1e-9)
    law = fx.nap(scene.profile, scene.bristle)
    loads = course.loads(ts)
    one, other = found.mode == 1, found.mode == -1
    np.testing.assert_allclose(loads[one] - low[one], law.rho_with, rtol=1e-9)
    np.testing.assert_allclose(loads[other] - high[other], -law.rho_flipped, rtol=1e-9)


def test_a_load_that_stays_leaves_it_where_it_is():
    """Stopped on the way over, and past its first jump."""
    for scene, stop in ((turning_scene(), 1.5), (jumping_scene(), 1.7)):
        value = float(scene.load(stop))
        knots = [0.0, 1.0, stop, 3.0], [0.0, float(scene.load(1.0)), value, value]
        held = scene.replace(load=fx.loads.PiecewiseLinear(*knots), duration=3.0)
        ts = np.array([stop, 2.0, 3.0])
        found, there = course_of(held).at(ts), course_of(scene).at(ts[:1])
        for name in ("z", "root", "tip", "mode", "dissipation"):
            value = getattr(there, name)[0]
            np.testing.assert_allclose(getattr(found, name), value, atol=1e-9)
