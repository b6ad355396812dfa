"""Designs of scenes with effects: forces of all bristles, or a refusal by name."""

import dataclasses

import jax
import numpy as np
import pytest
from samples import central

import frictionjax as fx
from frictionjax.design.surface.result import ProfileFit

WAVES = fx.profiles.Fourier(cos=[0.01, 0.004, 0.0], sin=[0.02, 0.0, -0.003])
ANGULAR = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
VERTICAL = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
LEADING, THREE = fx.effects.LeadingOrder(), fx.effects.CompliantArray([0.1, 0.2, 0.7])
TWO = fx.effects.RigidArray([0.25, -1.75], [0.5, 1.5])
APART = fx.effects.RigidArray([0.0, 0.1, 0.45], [1.0, 2.0, 0.5])
SCENES = [((LEADING,), 1), ((THREE,), 3), ((TWO,), 2), ((TWO, THREE, LEADING), 6)]
NAMES = ["leading", "compliant", "rigid", "all"]
SPREADS = {"stiffness": 0.01, "profile.sin[0]": 1e-3}


def friction_of(profile, bristle, effects):
    """Of the scene, and of all bristles where each has its own support."""
    parts = fx.supports.Spring(1.0), fx.loads.Ramp(1.0, 0.0)
    law = fx.friction(fx.Scene(profile, bristle, *parts, 1.0, effects=effects))
    many = 3 if THREE in effects else 1
    return many * float(law.rho_plus), many * float(law.rho_minus)


@pytest.mark.parametrize(("effects", "count"), SCENES, ids=NAMES)
def test_bristles_that_pull_alike_ask_for_the_surface_of_one(effects, count):
    one = fx.fit_profile(fx.Target(ANGULAR, 0.05, -0.07))
    target = fx.Target(ANGULAR, count * 0.05, -count * 0.07)
    fit = fx.fit_profile(target, effects=effects)
    assert fit.success
    for name in ("cos", "sin"):
        found, wanted = (getattr(each.profile, name) for each in (fit, one))
        np.testing.assert_allclose(found, wanted, atol=1e-16)
    assert fit.bending_energy == pytest.approx(one.bending_energy, rel=1e-13)
    found = friction_of(fit.profile, ANGULAR, effects)
    np.testing.assert_allclose(found, target[1:3], rtol=1e-12)
    law = fit.coefficients[0]
    np.testing.assert_allclose([law.rho_plus, law.rho_minus], target[1:3], rtol=1e-12)
    assert law.alpha == pytest.approx(count * float(one.coefficients[0].alpha), rel=1e-13)
    again = ProfileFit.from_json(fit.to_json())
    assert [type(effect) for effect in again.effects] == [type(e) for e in effects]
    assert again.message == fit.message


@pytest.mark.slow
def test_numbers_of_bristles_are_fitted_with_it():
    """Of as many bristles that each are as much softer the same surface."""
    known = {"free": "stiffness", "bounds": {"stiffness": (0.2, 5.0)}, "starts": 2}
    fit = fx.fit_profile(fx.Target(ANGULAR, 0.15, -0.2), effects=(THREE,), **known)
    assert fit.success
    found = friction_of(fit.profile, fit.bristles[0], (THREE,))
    np.testing.assert_allclose(found, (0.15, -0.2), rtol=1e-9)


@pytest.mark.parametrize(("effects", "count"), SCENES, ids=NAMES)
def test_bristles_that_pull_alike_ask_for_the_angle_of_one(effects, count):
    one = fx.fit_angle(WAVES, ANGULAR, rho_plus=0.05)
    fit = fx.fit_angle(WAVES, ANGULAR, rho_plus=count * 0.05, effects=effects)
    assert float(fit.value) == pytest.approx(float(one.value), rel=1e-14)
    for name in ("target", "achieved", "alpha", "reachable"):
        wanted = count * getattr(one, name)
        np.testing.assert_allclose(getattr(fit, name), wanted, rtol=1e-13)
    np.testing.assert_allclose(fit.curve(5)[1], count * one.curve(5)[1], rtol=1e-13)
    found = friction_of(WAVES, fit.bristle, effects)
    assert found[0] == pytest.approx(count * 0.05, rel=1e-12)
    moved, alone = fit.sensitivities, one.sensitivities
    assert moved.target == pytest.approx(float(alone.target) / count, rel=1e-13)
    np.testing.assert_allclose(moved.profile.sin, alone.profile.sin, rtol=1e-13)
    again = type(fit).from_json(fit.to_json())
    assert again.message == fit.message
    assert [type(effect) for effect in again.effects] == [type(e) for e in effects]


def test_a_ratio_is_that_of_one():
    one = fx.fit_angle(WAVES, ANGULAR, ratio=0.4)
    fit = fx.fit_angle(WAVES, ANGULAR, ratio=0.4, effects=(TWO, THREE))
    assert float(fit.value) == float(one.value)
    assert float(fit.achieved) == float(one.achieved)
    assert float(fit.sensitivities.target) == float(one.sensitivities.target)
    assert fit.alpha == pytest.approx(6 * float(one.alpha), rel=1e-13)


def test_tips_at_phases_of_their_own_ask_for_the_stiffness_of_their_sum():
    known = {"free": "stiffness", "effects": (APART, THREE)}
    fit = fx.fit_angle(WAVES, VERTICAL, rho_plus=0.3, **known)
    found = friction_of(WAVES, fit.bristle, (APART, THREE))
    assert found[0] == pytest.approx(0.3, rel=1e-12)


def test_their_sensitivities_are_finite_differences():
    known = {"free": "stiffness", "effects": (APART, THREE)}
    moved = fx.fit_angle(WAVES, VERTICAL, rho_plus=0.3, **known).sensitivities

    def value(target, sin):
        surface = WAVES.replace(sin=np.array([0.02, 0.0, sin]))
        return float(fx.fit_angle(surface, VERTICAL, rho_plus=target, **known).value)

    by_target = central(lambda target: value(target, -0.003), 0.3, 1e-5)
    assert moved.target == pytest.approx(by_target, rel=1e-7)
    by_sin = central(lambda sin: value(0.3, sin), -0.003, 1e-6)
    assert moved.profile.sin[2] == pytest.approx(by_sin, rel=1e-6)


@pytest.mark.slow
def test_weights_and_targets_have_derivatives():
    def value(weight, target):
        array = fx.effects.RigidArray(np.zeros(2), jax.numpy.stack([1.0, weight]))
        fit = fx.fit_angle(WAVES, ANGULAR, rho_plus=target, effects=(array,))
        return fit.value

    found = jax.grad(value, argnums=(0, 1))(1.5, 0.12)
    by_weight = central(lambda weight: float(value(weight, 0.12)), 1.5, 1e-5)
    by_target = central(lambda target: float(value(1.5, target)), 0.12, 1e-6)
    np.testing.assert_allclose(found, (by_weight, by_target), rtol=1e-6)


@pytest.mark.parametrize("effects", [(TWO, THREE), (APART, THREE)], ids=["alike", "apart"])
def test_cells_of_a_map_are_scenes(effects):
    axes = ("height", [0.5, 1.0]), ("stiffness", [1.0, 2.0])
    data = fx.design_map(VERTICAL, *axes, profile=WAVES, effects=effects)
    alone = fx.design_map(VERTICAL, *axes, profile=WAVES)
    for height in (0.5, 1.0):
        cell = data.sel(height=height, stiffness=2.0)
        part = VERTICAL.replace(height=height, stiffness=2.0)
        found = [float(cell[name]) for name in ("rho_plus", "rho_minus")]
        np.testing.assert_allclose(found, friction_of(WAVES, part, effects), rtol=1e-12)
        assert float(cell.ratio) == pytest.approx(-found[0] / found[1], rel=1e-12)
        assert float(cell.difference) == pytest.approx(sum(found), rel=1e-12)
        if effects == (TWO, THREE):
            one = float(alone.alpha.sel(height=height, stiffness=2.0))
            assert float(cell.alpha) == pytest.approx(6 * one, rel=1e-12)


@pytest.mark.slow
def test_slides_of_a_map_are_those_of_the_leading_order():
    axes = ("height", [0.5, 1.0]), ("stiffness", [1.0, 2.0])
    known = {"eps": 0.05, "effects": (LEADING,)}
    data = fx.design_map(VERTICAL, *axes, profile=WAVES, **known)
    spread = fx.tolerance(WAVES, VERTICAL, SPREADS, 2, **known).data
    wanted = fx.steady_slide(WAVES, VERTICAL, **known)
    cell = data.sel(height=1.0, stiffness=1.0)
    for name in ("mean_plus", "peak_minus"):
        force = float(getattr(wanted, name))
        assert float(cell[name]) == pytest.approx(force, rel=1e-9)
        found = float(spread.slide_nominal.sel(force=name))
        assert found == pytest.approx(force, rel=1e-9)
        whole = fx.steady_slide(WAVES, VERTICAL, eps=0.05)
        assert abs(float(getattr(whole, name)) / force - 1) > 1e-6


@pytest.mark.parametrize(
    "effects",
    [
        pytest.param((TWO, THREE), id="alike", marks=pytest.mark.slow),
        pytest.param((APART, THREE), id="apart", marks=pytest.mark.slow),
    ],
)
def test_tolerances_are_of_all_bristles(effects):
    known = {"samples": 50, "quantiles": [0.5]}
    data = fx.tolerance(WAVES, VERTICAL, SPREADS, **known, effects=effects).data
    found = data.nominal.sel(quantity=["rho_plus", "rho_minus"])
    np.testing.assert_allclose(found, friction_of(WAVES, VERTICAL, effects), rtol=1e-12)
    plus, minus = (float(value) for value in found)
    more = friction_of(WAVES, VERTICAL.replace(stiffness=1.01), effects)[0]
    own = data.by_number.sel(number="stiffness")
    assert float(own.sel(quantity="rho_plus")) == pytest.approx(more - plus, rel=1e-9)
    assert float(own.sel(quantity="ratio")) == pytest.approx(0.0, abs=1e-12)
    values = [
        friction_of(
            WAVES.replace(sin=np.array([0.02 + step, 0, -0.003])), VERTICAL, effects
        )
        for step in (1e-6, -1e-6)
    ]
    by_sin = 1e-3 * abs(values[0][1] - values[1][1]) / 2e-6
    told = data.by_number.sel(number="profile.sin[0]", quantity="rho_minus")
    assert float(told) == pytest.approx(by_sin, rel=1e-6)
    if effects == (TWO, THREE):
        one = fx.tolerance(WAVES, VERTICAL, SPREADS, **known).data
        for name, count in (("rho_plus", 6), ("ratio", 1), ("difference", 6)):
            for column in ("mean", "std", "first_order", "quantiles"):
                pair = (each[column].sel(quantity=name).values for each in (data, one))
                mine, alone = pair
                np.testing.assert_allclose(mine, count * alone, rtol=1e-10)
    assert minus < 0


CALLS = {
    "fit_profile": lambda effects, bristle=ANGULAR: fx.fit_profile(
        fx.Target(bristle, 0.05, -0.07), effects=effects
    ),
    "fit_angle": lambda effects, bristle=ANGULAR: fx.fit_angle(
        WAVES, bristle, rho_plus=0.05, free="stiffness", effects=effects
    ),
    "design_map": lambda effects, bristle=ANGULAR: fx.design_map(
        bristle, ("height", [1.0]), ("stiffness", [1.0]), profile=WAVES, effects=effects
    ),
    "tolerance": lambda effects, bristle=ANGULAR: fx.tolerance(
        WAVES, bristle, {"stiffness": 0.1}, 2, effects=effects
    ),
}
REFUSED = {
    "Noise": (fx.effects.Noise(1e-4), "design without it, and friction_curve"),
    "Inertia": (fx.effects.Inertia(1e-4), "design without it, and sweep"),
    "AxialLoad": (fx.effects.AxialLoad(1.0), "design without it, and mechanics"),
    "NapFlip": (fx.effects.NapFlip(0.1), "nap, of one design"),
}


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("name", REFUSED)
def test_what_no_formula_is_for_is_refused(call, name):
    effect, instead = REFUSED[name]
    if name == "NapFlip" and call.startswith("fit"):
        pytest.skip("done")
    with pytest.raises(
        ValueError, match=rf"{call}.* does not do {name}: needs .*{instead}"
    ):
        CALLS[call]((effect,))


@pytest.mark.parametrize("call", CALLS)
def test_bad_effects_are_named(call):
    ask = CALLS[call]
    for given, message in (
        (LEADING, r"effects = .*needs effects of frictionjax\.effects in a tuple"),
        ((LEADING, LEADING), "LeadingOrder and LeadingOrder: needs one of each kind"),
        ((APART,), "bristle = 'AngularSpring': needs tips of effects.RigidArray at one"),
    ):
        with pytest.raises(ValueError, match=message):
            ask(given)
    if call != "fit_profile":
        spread = fx.effects.RigidArray([0.0, 0.5])
        odd = fx.profiles.Sine(0.1)
        message = "RigidArray: rho_plus = 0: needs tips whose forces do not cancel"
        with pytest.raises(ValueError, match=message):
            {
                "fit_angle": lambda: fx.fit_angle(
                    odd, VERTICAL, rho_plus=0.1, free="height", effects=(spread,)
                ),
                "design_map": lambda: fx.design_map(
                    VERTICAL,
                    ("height", [1.0]),
                    ("stiffness", [1.0]),
                    profile=odd,
                    effects=(spread,),
                ),
                "tolerance": lambda: fx.tolerance(
                    odd, VERTICAL, {"stiffness": 0.1}, 2, effects=(spread,)
                ),
            }[call]()


def test_what_arrays_are_not_asked_with_is_named():
    target, stiff = fx.Target(VERTICAL, 0.05, -0.07), ("stiffness", [1.0])
    for effects, more, message in (
        ((APART,), {"smallest_radius": 0.1}, "smallest_radius = 0.1: needs tips of"),
        ((APART,), {"largest_amplitude": 0.1}, "largest_amplitude = 0.1: needs tips of"),
        (
            (APART,),
            {"free": "stiffness", "bounds": {"stiffness": (0.5, 2.0)}},
            "free = 'stiffness': needs tips of",
        ),
    ):
        with pytest.raises(ValueError, match=message):
            fx.fit_profile(target, effects=effects, **more)
    with pytest.raises(ValueError, match=r"effects = 'RigidArray': needs .* beside asymm"):
        fx.design_map(VERTICAL, stiff, "asymmetry", effects=(APART,))
    for effect in (TWO, THREE):
        known = {"eps": 0.01, "effects": (effect,)}
        with pytest.raises(ValueError, match="needs LeadingOrder alone where eps is given"):
            fx.design_map(VERTICAL, stiff, ("height", [1.0]), profile=WAVES, **known)
        with pytest.raises(ValueError, match="needs LeadingOrder alone where eps is given"):
            fx.tolerance(WAVES, VERTICAL, SPREADS, 2, **known)


def test_a_result_without_effects_has_no_numbers_of_theirs():
    fit = fx.fit_angle(WAVES, ANGULAR, ratio=0.4)
    more = dataclasses.replace(fit, scene=None)
    assert jax.tree.structure(fit).num_leaves == jax.tree.structure(more).num_leaves
