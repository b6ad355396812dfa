"""Effects that an accuracy does not call for are left out, and said to be."""

import jax
import numpy as np
import pytest
from tips_with_mass import mass_for, massive_scene

import frictionjax as fx
from frictionjax.called_for import simulated

EPS, GAMMA = 1e-2, 1.0
TS = np.linspace(0.0, 3.0, 61)
LIGHT = massive_scene(mass_for(1e-5, EPS, GAMMA))
HEAVY = massive_scene(mass_for(2.0, EPS, GAMMA))


def test_a_light_mass_is_left_out_and_said_to_be():
    found = fx.solve(LIGHT, EPS, GAMMA, TS, effects="auto")
    plain = fx.solve(LIGHT.replace(effects=()), EPS, GAMMA, TS)
    np.testing.assert_array_equal(found.z, plain.z)
    assert found.velocity is None
    told = fx.explain(LIGHT, EPS, GAMMA).effects.in_z.sel(effect="Inertia")
    assert found.stats["left_out"] == {"Inertia": pytest.approx(float(told) / EPS)}
    assert "without Inertia (at most" in found.stats["values"]


def test_what_was_left_out_changes_less_than_the_accuracy():
    light = massive_scene(mass_for(2e-4, EPS, GAMMA))
    whole = fx.solve(light, EPS, GAMMA, TS, 1e-3)
    found = fx.solve(light, EPS, GAMMA, TS, 1e-3, effects="auto")
    assert "Inertia" in found.stats["left_out"]
    assert np.max(np.abs(whole.z - found.z)) <= 2e-3 * EPS  # either is good to 1e-3


def test_a_heavy_mass_stays():
    found = fx.solve(HEAVY, EPS, GAMMA, TS, effects="auto")
    np.testing.assert_array_equal(found.z, fx.solve(HEAVY, EPS, GAMMA, TS).z)
    assert found.velocity is not None
    assert found.stats["left_out"] == {}


def test_an_accuracy_that_asks_for_less_leaves_out_more():
    one = massive_scene(mass_for(2e-3, EPS, GAMMA))
    coarse = fx.solve(one, EPS, GAMMA, TS, 1e-1, effects="auto")
    fine = fx.solve(one, EPS, GAMMA, TS, 1e-5, effects="auto")
    assert [set(s.stats["left_out"]) for s in (coarse, fine)] == [{"Inertia"}, set()]


def test_a_sweep_leaves_out_what_no_cell_calls_for():
    """A constant mass weighs more as eps falls: beta goes with eps^-3 at gamma = 1."""
    alone = fx.sweep(LIGHT, [EPS], [GAMMA], TS, effects="auto")
    assert alone.attrs["left_out"].startswith("Inertia (at most ")
    assert "beta" not in alone
    grid = [EPS, EPS / 30], [GAMMA], [0.0, 0.1]
    both = fx.sweep(LIGHT, *grid, effects="auto", suprema=False)  # no slip after 0.1 s
    assert "left_out" not in both.attrs
    assert "beta" in both
    plain = fx.sweep(LIGHT.replace(effects=()), [EPS], [GAMMA], TS)
    np.testing.assert_array_equal(alone.z, plain.z)


def test_scenes_of_a_sweep_are_each_told():
    scenes = {"light": LIGHT, "none": LIGHT.replace(effects=())}
    data = fx.sweep(scenes, [EPS], [GAMMA], TS, effects="auto")
    assert data.attrs["left_out"].startswith("light: Inertia (at most ")
    assert "none" not in data.attrs["left_out"]


def test_noise_that_is_cold_is_left_out_with_its_key():
    cold = LIGHT.replace(effects=(fx.effects.Noise(1e-12),))
    found = fx.solve(cold, EPS, GAMMA, TS, effects="auto", key=3)
    np.testing.assert_array_equal(
        found.z, fx.solve(cold.replace(effects=()), EPS, GAMMA, TS).z
    )
    warm = LIGHT.replace(effects=(fx.effects.Noise(1e-3),))
    kept = fx.solve(warm, EPS, GAMMA, TS, effects="auto", key=3)
    np.testing.assert_array_equal(kept.z, fx.solve(warm, EPS, GAMMA, TS, key=3).z)
    swept = fx.sweep(warm, [EPS], [GAMMA], TS, effects="auto", key=3)
    same = fx.sweep(warm, [EPS], [GAMMA], TS, key=3)
    np.testing.assert_array_equal(swept.z, same.z)
    left = fx.sweep(cold, [EPS], [GAMMA], TS, effects="auto", key=3)
    assert left.attrs["left_out"].startswith("Noise (at most")
    assert "path_key" not in left


@pytest.mark.parametrize(
    "effect",
    [
        pytest.param(fx.effects.LeadingOrder(), id="leading"),
        # A program of its own.
        pytest.param(fx.effects.RigidArray([0.0, 0.1]), id="array", marks=pytest.mark.slow),
    ],
)
def test_effects_of_the_potential_stay(effect):
    scene = LIGHT.replace(effects=(effect, *LIGHT.effects))
    found = fx.solve(scene, EPS, GAMMA, TS, effects="auto")
    plain = fx.solve(scene.replace(effects=(effect,)), EPS, GAMMA, TS)
    np.testing.assert_array_equal(found.z, plain.z)


def test_arrays_are_another_scene_and_stay():
    scene = LIGHT.replace(effects=(fx.effects.CompliantArray([0.0, 0.3]),))
    found = fx.solve(scene, EPS, GAMMA, TS, effects="auto")
    assert "spread" in found.stats
    assert found.stats["left_out"] == {}


def test_without_slides_nothing_is_known_and_all_stays():
    wild = massive_scene(mass_for(1e-5, EPS, GAMMA), load=fx.loads.Triangle(1.0, 1e-3))
    found = fx.solve(wild, EPS, GAMMA, [0.0, 0.01], effects="auto")
    assert found.stats["left_out"] == {}


def test_other_words_and_traced_scenes_are_refused():
    with pytest.raises(ValueError, match=r"effects = 'some': needs 'all' or 'auto'"):
        fx.solve(LIGHT, EPS, GAMMA, TS, effects="some")
    with pytest.raises(ValueError, match="effects = 'none': needs"):
        fx.sweep(LIGHT, [EPS], [GAMMA], effects="none")

    def end(stiffness):
        support = fx.supports.Spring(stiffness)
        scene = LIGHT.replace(effects=(), support=support)
        return fx.solve(scene, EPS, GAMMA, TS, effects="auto").z[-1]

    with pytest.raises(ValueError, match="effects = 'auto': needs 'all' where"):
        jax.grad(end)(1.0)


def turning_on_a_fold(effect):
    """A tip that slips or stays by 1e-10 N: with this mass and without, a well apart."""
    parts = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0), fx.supports.Spring(1.0)
    load = fx.loads.Triangle(0.30203749510983474, 4.0)
    return fx.Scene(*parts, load, 2.0, effects=(effect,))


@pytest.mark.parametrize(
    "effect",
    [fx.effects.Inertia(1.2732e-8), fx.effects.Noise(1e-9, exponent=0.0)],
    ids=["mass", "noise"],
)
def test_where_the_load_turns_on_a_fold_nothing_is_known_and_all_stays(effect):
    scene = turning_on_a_fold(effect)
    row = fx.explain(scene, 0.02, 1.0).effects.sel(effect=type(effect).__name__)
    assert np.isnan(float(row.in_z))
    assert bool(row.called_for)
    assert "turns on a fold" in str(row.source.values)
    kept = simulated(scene, "auto", 0.02, 1.0, 1e-3)
    assert kept.left_out == {}
    assert kept.scene is scene


def test_noise_that_makes_slips_early_by_more_than_they_take_is_told_as_a_well():
    """0.334 eps was told, and 0.98 seen of five keys in six."""
    cos, sin = (-0.0120897, 0.00680347, -0.0063478), (-0.0214011, 0.00307558, -0.0097133)
    bristle = fx.bristles.SlantedSpring(1.10332, 2.4, 1.0, -0.043261)
    parts = fx.profiles.Fourier(cos, sin), bristle, fx.supports.Spring(1.15191)
    noise = fx.effects.Noise(2.11289e-8, exponent=0.0)
    scene = fx.Scene(*parts, fx.loads.Sine(2.37835, 2.59538), 2.59538, effects=(noise,))
    row = fx.explain(scene, 0.0231593, 2.0).effects.sel(effect="Noise")
    assert not float(row.in_z) < 0.981 * 0.0231593
