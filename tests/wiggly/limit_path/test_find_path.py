"""The path of a scene is found once, and says how hard the load pulls."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.model import tabulated_scene
from frictionjax.wiggly import limit_path
from frictionjax.wiggly.limit_path import find_path


def scene_under(load: fx.loads.AbstractPull, stiffness: float = 1.0) -> fx.Scene:
    profile, bristle = fx.profiles.Sine(0.1), fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    return fx.Scene(profile, bristle, fx.supports.Spring(stiffness), load, 3.0)


def known(scene: fx.Scene, eps: float) -> limit_path.Path | None:
    return limit_path.known_path(scene, tabulated_scene(scene, eps))


def test_the_path_of_a_scene_is_found_once_whatever_the_eps():
    scene, same = (scene_under(fx.loads.Sine(1.2, 3.0)) for _ in range(2))
    path = known(scene, 0.1)
    assert known(scene, 1e-3) is path
    other = known(same, 1e-3)
    assert other is not path
    np.testing.assert_array_equal(other.states, path.states)
    np.testing.assert_array_equal(other.probes.speeds, path.probes.speeds)


def test_a_path_found_before_has_the_support_of_this_eps():
    curved = fx.supports.Convex(lambda z: z**2 / 2 + z**4 / 4)
    scene = scene_under(fx.loads.Sine(1.2, 3.0)).replace(support=curved)
    times = np.linspace(0.0, 3.0, 20)
    before, tables = known(scene, 0.1), tabulated_scene(scene, 1e-3)
    path = limit_path.known_path(scene, tables)
    assert path.support is tables.support is not before.support
    np.testing.assert_allclose(path.states_at(times), before.states_at(times), atol=1e-14)


def test_another_support_is_another_scene():
    scene = scene_under(fx.loads.Sine(1.2, 3.0))
    soft, stiff = (known(scene.replace(support=fx.supports.Spring(k)), 0.1) for k in (1, 2))
    np.testing.assert_allclose(soft.states, 2 * stiff.states, rtol=1e-12)


def test_paths_of_many_pieces_are_not_kept(monkeypatch):
    monkeypatch.setattr(find_path, "SETTINGS", find_path.SETTINGS._replace(few_pieces=3))
    few, many = (scene_under(fx.loads.Sine(1.2, period)) for period in (3.0, 1.0))
    assert known(few, 0.1) is known(few, 0.1)
    assert known(many, 0.1) is not known(many, 0.1)


def test_a_path_says_how_hard_the_load_pulls():
    pull = known(scene_under(fx.loads.Triangle(1.2, 3.0), stiffness=2.0), 0.1).pull
    assert float(pull.fastest) == pytest.approx(4 * 1.2 / 3.0)
    assert float(pull.softest) == pytest.approx(2.0)
    # From -1.2 N to 1.2 N, less what friction takes of 0.1 N on either side.
    assert float(pull.way) == pytest.approx((2.4 - 0.2) / 2)
