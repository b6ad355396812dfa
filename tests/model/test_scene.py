"""A scene can be changed, and is then what building it anew gives."""

import copy
import dataclasses
import pickle

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.model.scene import known_scene

PARTS = {
    "profile": fx.profiles.Fourier([0.0, 0.01], [0.02, 0.0]),
    "bristle": fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0),
    "support": fx.supports.Spring(1.0),
    "load": fx.loads.Sine(1.0488, 3.0),
    "duration": 3.0,
    "z0": 0.0,
}
SCENE = fx.Scene(**PARTS)
POINTS = fx.loads.PiecewiseLinear([1.0, 2.0, 3.0], [0.0, 1.0, -0.5])
LISTED = SCENE.replace(load=POINTS)
SHARE = np.linspace(0.0, 1.0, 7)


def anew(scene, **changes):
    given = PARTS | {"load": scene.load} | changes
    return fx.Scene(**given)


# What is changed, to what, and the arguments that building it anew takes.
CHANGES = {
    "a longer duration": (SCENE, lambda s: s.duration, 30.0, {"duration": 30.0}),
    "a whole number": (SCENE, lambda s: s.duration, 40, {"duration": 40.0}),
    "a shorter duration": (SCENE, lambda s: s.duration, 0.1, {"duration": 0.1}),
    "a shorter period": (
        SCENE,
        lambda s: s.load.period,
        0.01,
        {"load": fx.loads.Sine(1.0488, 0.01)},
    ),
    "a stiffer support": (
        SCENE,
        lambda s: s.support.stiffness,
        4.0,
        {"support": fx.supports.Spring(4.0)},
    ),
    "another start": (SCENE, lambda s: s.z0, 0.01, {"z0": 0.01}),
    "another surface": (
        SCENE,
        lambda s: s.profile.sin,
        jnp.array([0.03, 0.0]),
        {"profile": fx.profiles.Fourier([0.0, 0.01], [0.03, 0.0])},
    ),
    "more points of the load": (
        LISTED,
        lambda s: (s.load.times, s.load.values),
        (jnp.arange(9.0) / 4, jnp.arange(9) % 2),
        {"load": fx.loads.PiecewiseLinear(np.arange(9.0) / 4, np.arange(9) % 2)},
    ),
}
BAD = {
    "an angle without contact": (lambda s: s.bristle.angle, 1.55),
    "an angle out of range": (lambda s: s.bristle.angle, 2.0),
    "a support that pushes": (lambda s: s.support.stiffness, -1.0),
    "no duration": (lambda s: s.duration, 0.0),
    "a duration that is none": (lambda s: s.duration, float("nan")),
    "a text": (lambda s: s.z0, "0.1"),
    "a truth": (lambda s: s.duration, True),
    "a period that is negative": (lambda s: s.load.period, -3.0),
    "a flat surface": (
        lambda s: s.profile,
        eqx.tree_at(
            lambda p: p.sin, fx.profiles.Fourier([0.0, 0.0], [0.1, 0.0]), jnp.zeros(2)
        ),
    ),
    "too many turning points": (lambda s: s.load.period, 1e-7),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_changed_scene_is_what_building_it_anew_gives(name):
    scene, where, value, arguments = CHANGES[name]
    changed, built = eqx.tree_at(where, scene, value), anew(scene, **arguments)
    assert eqx.tree_equal(known_scene(changed), built)
    ts = SHARE * float(built.duration)
    expected = fx.solve_limit(built, ts).z
    assert np.array_equal(fx.solve_limit(changed, ts).z, expected)
    assert np.all(np.isfinite(expected))


@pytest.mark.parametrize("name", BAD)
def test_a_change_to_what_no_scene_allows_is_an_error(name):
    where, value = BAD[name]
    changed = eqx.tree_at(where, SCENE, value)
    with pytest.raises(ValueError, match=r"scene|bristle|support|load|profile"):
        fx.solve_limit(changed)


@pytest.mark.parametrize(
    "use",
    [
        lambda s: fx.solve(s, 0.1),
        lambda s: fx.solve_limit(s),
        lambda s: fx.sweep(s, [0.1], [1.0]),
        lambda s: fx.certify(s, 0.1, 1.0, [0.0, 1.0], [0.0, 0.0]),
        lambda s: fx.predict_cost(s, [0.1], measure=False),
        lambda s: fx.work_precision(s, [0.1], [1.0], ["auto"], [1e-3]),
        lambda s: fx.order_cost(s, 0.1),
        lambda s: fx.simulate_trace(s, 0.1),
        lambda s: fx.friction(s),
        lambda s: fx.steady_slide(s.profile, s.bristle, 0.01),
        lambda s: fx.fit_angle(s.profile, s.bristle, ratio=2.0),
        lambda s: fx.fit_profile(fx.Target(s.bristle, 0.1, -0.1)),
        lambda s: fx.design_map(s.bristle, "angle", "height", s.profile),
        lambda s: SCENE.replace(bristle=s.bristle),
    ],
)
def test_everything_that_takes_a_scene_or_a_part_looks_at_what_was_changed(use):
    changed = eqx.tree_at(lambda s: s.bristle.stiffness, SCENE, -1.0)
    with pytest.raises(ValueError, match=r"bristle\.stiffness = -1: needs stiffness > 0"):
        use(changed)


def test_a_function_that_was_changed_is_looked_at():
    class Wave(eqx.Module):
        height: jax.Array

        def __call__(self, y):
            return self.height * jnp.sin(2 * jnp.pi * y)

    profile = fx.profiles.Custom(Wave(jnp.asarray(0.01)), points=64)
    flat = eqx.tree_at(lambda p: p.fn.height, profile, jnp.asarray(0.0))
    with pytest.raises(ValueError, match="constant"):
        fx.friction(flat, PARTS["bristle"])


def test_replace_exchanges_any_argument_of_a_scene():
    longer = SCENE.replace(duration=30.0)
    assert eqx.tree_equal(longer, anew(SCENE, duration=30.0))
    assert eqx.tree_equal(dataclasses.replace(SCENE, duration=30.0), longer)
    faster = SCENE.replace(load=SCENE.load.replace(period=0.5), z0=0.01)
    assert eqx.tree_equal(faster, anew(SCENE, load=fx.loads.Sine(1.0488, 0.5), z0=0.01))
    other = SCENE.replace(profile=fx.profiles.Sine(0.1))
    assert eqx.tree_equal(other, anew(SCENE, profile=fx.profiles.Sine(0.1)))
    given = fx.GivenPotential(lambda Y: 0.1 * jnp.sin(2 * jnp.pi * Y), points=64)
    abstract = SCENE.replace(potential=given)
    assert abstract.profile is None
    both = {"profile": SCENE.profile, "bristle": SCENE.bristle}
    assert eqx.tree_equal(abstract.replace(**both), SCENE)
    assert abstract.replace(z0=0.01).potential is given
    if hasattr(copy, "replace"):
        assert eqx.tree_equal(copy.replace(SCENE, duration=30.0), longer)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"lenght": 1.0}, "Scene.replace: lenght = 1: needs .* one of profile, bristle"),
        ({"turns": 8}, "Scene.replace: turns = 8"),
        ({"duration": -1.0}, "scene.duration = -1"),
        ({"profile": 0.1}, "profile = 'float'"),
        ({"bristle": PARTS["bristle"], "potential": SCENE.potential}, "scene.bristle"),
    ],
)
def test_replace_says_what_is_wrong(change, said):
    with pytest.raises(ValueError, match=said):
        SCENE.replace(**change)


@pytest.mark.parametrize(
    ("part", "change"),
    [
        (fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.1), {"height": 1.1}),
        (fx.profiles.Spline([0.0, 0.01, 0.0, -0.02]), {"heights": [0.0, 0.1, 0.0, 0.0]}),
        (fx.loads.Custom(jnp.cos, [3.0]), {"turning_points": []}),
        (fx.supports.Convex(lambda z: z**2), {"energy": jnp.cosh}),
        (fx.bristles.Custom(lambda h: 0 * h, lambda h: h), {"energy": lambda h: 2 * h}),
    ],
)
def test_a_part_can_be_changed(part, change):
    changed = part.replace(**change)
    assert type(changed) is type(part)
    assert not eqx.tree_equal(changed, part)
    with pytest.raises(ValueError, match="replace: z0 = 1: needs an argument of"):
        part.replace(z0=1.0)


def test_what_was_not_changed_is_not_looked_at_again():
    assert known_scene(SCENE) is SCENE
    assert known_scene(copy.deepcopy(SCENE)).turns == SCENE.turns
    assert known_scene(pickle.loads(pickle.dumps(SCENE))).turns == SCENE.turns
    changed = eqx.tree_at(lambda s: s.duration, SCENE, 30.0)
    assert known_scene(changed) is known_scene(changed)


def test_a_traced_change_has_its_room_or_says_that_it_has_not():
    longer = eqx.tree_at(lambda s: s.duration, SCENE, 30.0)

    def by_start(z0):
        return fx.solve_limit(eqx.tree_at(lambda s: s.z0, longer, z0), 30.0 * SHARE).z

    expected = fx.solve_limit(longer, 30.0 * SHARE).z
    assert np.allclose(jax.jit(by_start)(0.0), expected, rtol=0, atol=1e-14)

    def by_duration(duration):
        scene = eqx.tree_at(lambda s: s.duration, SCENE, duration)
        return fx.solve_limit(scene, SHARE * duration)

    found = jax.vmap(by_duration)(jnp.array([3.0, 30.0, 1.0]))
    assert found.ok.tolist() == [True, False, True]
    assert found.status[1].name == "NOT_FINITE"
    assert "2 of 3 OK, 1 NOT_FINITE" in repr(found)
    assert np.isnan(jax.grad(lambda d: by_duration(d).z[-1])(30.0))


@pytest.mark.slow
def test_a_traced_solve_says_that_it_has_no_room():
    def run(duration):
        scene = eqx.tree_at(lambda s: s.duration, SCENE, duration)
        return fx.solve(scene, 0.1, ts=SHARE[:3] * 0.1).status_code

    codes = jax.vmap(run)(jnp.array([3.0, 30.0]))
    assert codes.tolist() == [fx.Status.OK, fx.Status.TOO_MANY_TURNS]


def test_a_scene_of_32_bits_is_checked_in_64():
    """It was built before `jax_enable_x64` was set, when nothing can be checked."""
    with jax.enable_x64(False):
        bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.55)
        support, load = fx.supports.Spring(1.0), fx.loads.Ramp(1.0)
        scene = fx.Scene(fx.profiles.Sine(0.1), bristle, support, load, 1.0)
    with pytest.raises(ValueError, match=r"bristle\.angle = 1\.55"):
        fx.solve_limit(scene)
