"""What brackets are told of slides before anything runs."""

import jax
import numpy as np
import pytest
from flat_folds import SCENES, VERTICAL, scene_of
from paths import path_of

import frictionjax as fx
from frictionjax._checks import viscosity_of
from frictionjax.model import tabulated_scene
from frictionjax.wiggly.enclosure import SETTINGS
from frictionjax.wiggly.plan import lane_scene, planned
from frictionjax.wiggly.slip_map import steady_lags, wells_both_ways


@pytest.mark.parametrize("name", SCENES)
def test_lags_of_slower_slides_are_bounded(name):
    """Brackets set off behind tips on slow parts of slides too."""
    eps, gamma = np.array([1e-4, 1e-6, 1e-8]), np.array([0.4, 0.4, 0.5])
    scene = tabulated_scene(SCENES[name], eps)
    path = path_of(SCENES[name])
    plan = planned(scene, path, eps, gamma, 3, 1e-3, "auto")
    ground, drag = plan.ground, path.speed * viscosity_of(eps, gamma)
    wells = wells_both_ways(scene.potential, eps, plan.control.folds)
    for share in (0.5, 0.2, 0.1, 0.05):
        slower = steady_lags(wells, share * drag)
        for side, direction in zip(slower.force, (1, -1), strict=True):
            power = ground.power(np.arange(3), np.full(3, direction))
            fastest = ground.lags[:, 0 if direction > 0 else 1]
            bound = SETTINGS.faster * share**power * fastest
            assert np.all(side / path.stiffness <= bound), (share, direction)


def test_memory_is_lag_times_its_power_of_the_speed():
    """Twice the lag at a fold with a curvature, once where flanks are straight."""
    for name, times in (("sawtooth", 1.02), ("quartic", 4 / 3)):
        eps, gamma = np.array([1e-6]), np.array([0.75])
        scene, path = tabulated_scene(SCENES[name], eps), path_of(SCENES[name])
        ground = planned(scene, path, eps, gamma, 3, 1e-3, "auto").ground
        assert ground.memories[:, 0] / ground.lags[:, 0] == pytest.approx(times, rel=0.02)
    sine = scene_of(fx.profiles.Sine(0.1), VERTICAL)
    scene, path = tabulated_scene(sine, eps), path_of(sine)
    ground = planned(scene, path, eps, gamma, 3, 1e-3, "auto").ground
    assert ground.memories[:, 1] / ground.lags[:, 1] == pytest.approx(2.0, rel=0.01)


def test_pieces_need_what_their_direction_does():
    """Sawtooth: a hundred times less to the left, and as much where lags go on."""
    eps, gamma = np.array([1e-8]), np.array([0.75])
    scene, path = tabulated_scene(SCENES["sawtooth"], eps), path_of(SCENES["sawtooth"])
    needs = planned(scene, path, eps, gamma, 3, 1e-3, "auto").needs
    assert needs.share[0, 0] == needs.share[0, 2] == 1.0
    assert needs.share[0, 1] < 0.02
    saw = SCENES["sawtooth"]
    triangle = fx.loads.Triangle(1.0, 3.0)  # turns at full speed
    abrupt = fx.Scene(saw.profile, saw.bristle, saw.support, triangle, 3.0)
    scene, path = tabulated_scene(abrupt, eps), path_of(abrupt)
    needs = planned(scene, path, eps, gamma, 3, 1e-3, "auto").needs
    assert np.all(needs.share == 1.0)


def test_lanes_of_surfaces_in_pieces_are_of_one_kind_however_many_samples():
    """Which planning takes: 256 a period of 12 heights, 4096 of 200."""
    splines = (
        fx.profiles.Spline(0.01 * np.sin(2 * np.pi * np.arange(n) / n)) for n in (12, 200)
    )
    tables = [tabulated_scene(scene_of(spline, VERTICAL), 1e-2) for spline in splines]
    points = [one.potential.profile.points for one in tables]
    assert points == [256, 4096]
    one, other = (jax.tree_util.tree_structure(lane_scene(table)) for table in tables)
    assert one == other


def test_no_more_slips_are_remembered_than_there_are():
    """A rise of the load within 3e-4 s: tolerances were for 6e5 slips, of 2000."""
    load = fx.loads.PiecewiseLinear([0.0, 1.0, 1.0003, 3.0], [0.0, 0.5, 1.5, 0.2])
    parts = fx.profiles.Sine(0.1), VERTICAL, fx.supports.Spring(1.0), load
    scene, ts = fx.Scene(*parts, 3.0), [0.9, 1.0, 2.0, 3.0]
    found, truth = (fx.solve(scene, 1e-3, 0.5, ts, accuracy) for accuracy in (1e-3, 1e-6))
    assert found.ok
    assert found.stats["tolerance"] > 2e-9  # 3.2e-11 before
    assert np.max(np.abs(found.z - truth.z)) < 0.1 * 1e-3 * 1e-3


def test_run_ups_are_what_is_left_of_half_a_well_after_landing():
    """Where that is long enough to forget: lanes set off where the tip has just landed."""
    sine = scene_of(fx.profiles.Sine(0.1), SCENES["sawtooth"].bristle)
    eps, gamma = np.array([1e-4, 3e-5]), np.array([1.0, 1.0])
    scene, path = tabulated_scene(sine, eps), path_of(sine)
    ground, needs = planned(scene, path, eps, gamma, 3, 1e-3, "auto")[1:3]
    landed = ground.landed.max(axis=1)
    shift = ground.shifts.max(axis=1) / eps
    assert np.all(needs.settles)
    late = landed + SETTINGS.beyond + shift  # at the bound itself it is a well earlier
    assert needs.run_up == pytest.approx(0.5 - late, rel=1e-12)
