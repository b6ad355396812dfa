"""Times at which states with and without an effect are compared."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.called_for import setting_of
from frictionjax.explain.telling_times import telling_times, thinned

PARTS = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0), fx.supports.Spring(2.0)
NO_TURNS = np.array([])


def scene_of(load, duration=3.0):
    return fx.Scene(*PARTS, load, duration)


@pytest.mark.parametrize("eps", [0.05, 1e-3])
def test_half_a_percent_of_a_well_is_what_the_load_takes_for_it(eps):
    """A triangle of 4/3 N/s on 2 N/m goes 2/3 m/s."""
    found = telling_times(
        setting_of(scene_of(fx.loads.Triangle(1.0, 3.0)), eps, 1.0), NO_TURNS
    )
    np.testing.assert_allclose(found.away, 0.005 * eps / (2 / 3), rtol=1e-6)
    assert np.min(found.at) == pytest.approx(0.0, abs=1e-9)
    assert np.max(found.at) == pytest.approx(3.0)


@pytest.mark.parametrize("eps", [0.1, 1e-3, 1e-8])
def test_smaller_eps_are_told_by_no_more_times_and_wells(eps):
    """Wells that are seen of each of three slides: all, or those of a few windows."""
    scene = scene_of(fx.loads.Sine(1.0488, 3.0))
    found = telling_times(setting_of(scene, eps, 1.0), NO_TURNS)
    assert found.at.size < 25_000
    z = np.asarray(fx.solve_limit(scene, np.sort(found.at)).z)
    assert np.unique(np.floor(z / eps)).size < 120


def test_of_a_slide_all_its_wells_are_seen_where_they_are_few():
    scene = scene_of(fx.loads.Ramp(1.0, 0.0), 1.0)
    found = telling_times(setting_of(scene, 0.05, 1.0), NO_TURNS)
    z = np.asarray(fx.solve_limit(scene, np.sort(found.at)).z)
    steps = np.diff(z) / 0.05
    assert z[-1] == pytest.approx(0.45)
    assert np.max(steps) < 0.0101  # of a well


def test_before_and_after_a_turn_times_are_dense():
    """Of a well before it, and of the way to the next slide after it."""
    scene = scene_of(fx.loads.Sine(1.0488, 3.0))
    times = np.sort(telling_times(setting_of(scene, 1e-3, 1.0), np.array([0.75])).at)
    last = np.sqrt(2 * 1e-3 * 2.0 / (1.0488 * (2 * np.pi / 3) ** 2))
    inside = times[(times > 0.75 - last) & (times < 0.75 + last)]
    assert inside.size > 200
    assert np.max(np.diff(inside)) < 0.02 * last


def test_of_many_turns_those_on_folds_are_kept():
    scene = scene_of(fx.loads.Triangle(1.0, 0.1), 3.0)
    at = setting_of(scene, 0.05, 1.0)
    few = telling_times(at, NO_TURNS).at
    assert few.size < 0.15 * telling_times(at, np.asarray(scene.turning_points())).at.size
    turn = np.asarray(scene.turning_points())[30]
    near = telling_times(at, np.array([turn])).at
    assert np.sum(np.abs(near - turn) < 0.02) > np.sum(np.abs(few - turn) < 0.02) + 500


def test_a_load_that_stands_still_is_looked_at_too():
    load = fx.loads.PiecewiseLinear([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 1.0, 0.0])
    found = telling_times(setting_of(scene_of(load), 0.01, 1.0), NO_TURNS)
    assert np.sum((found.at > 1.0) & (found.at < 2.0)) > 50
    assert np.all(found.away > 0)


def test_a_few_of_many_are_chosen_evenly():
    assert thinned(np.arange(10), 4).tolist() == [0, 3, 6, 9]
    assert thinned(np.arange(3), 4).tolist() == [0, 1, 2]
    assert thinned(np.arange(0), 4).size == 0
