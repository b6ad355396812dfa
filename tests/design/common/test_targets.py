"""Targets by the nap: with it and against it, whichever way that is."""

import numpy as np
import pytest

import frictionjax as fx

RIGHT = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.4)
LEFT = RIGHT.replace(angle=-0.4)
ANGULAR = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)


@pytest.mark.parametrize("bristle", [RIGHT, LEFT, ANGULAR], ids=["right", "left", "rod"])
def test_surfaces_give_the_friction_of_the_nap(bristle):
    fit = fx.fit_profile(fx.Target.of_nap(bristle, with_nap=0.05, against_nap=0.09))
    assert fit.success
    found = fx.nap(fit.profile, bristle)
    np.testing.assert_allclose([found.rho_with, found.rho_against], [0.05, 0.09], rtol=1e-9)
    assert fit.naps[0].rho_against == found.rho_against


def test_mirrored_bristles_swap_the_ways():
    right, left = (fx.Target.of_nap(part, 0.05, 0.09) for part in (RIGHT, LEFT))
    assert (right.rho_plus, right.rho_minus) == (0.05, -0.09)
    assert (left.rho_plus, left.rho_minus) == (0.09, -0.05)
    both = [fx.fit_profile(target).profile for target in (right, left)]
    y = np.linspace(0, 1, 9)
    # One is the other in a mirror: its steepest place, at 0, is the lowest slope of that.
    np.testing.assert_allclose(both[1](0.5 - y), both[0](y), rtol=1e-12, atol=1e-16)


def test_uncertainties_go_with_their_friction():
    spreads = (0.01, 0.02)
    right, left = (
        fx.Target.of_nap(part, 0.05, 0.09, 2.0, spreads) for part in (RIGHT, LEFT)
    )
    assert tuple(right.uncertainty) == spreads
    assert tuple(left.uncertainty) == spreads[::-1]
    assert fx.Target.of_nap(LEFT, 0.05, 0.09, uncertainty=0.01).uncertainty == 0.01
    assert right.weight == left.weight == 2.0


def test_what_has_no_nap_is_named():
    upright = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    message = "needs one that leans, SlantedSpring or AngularSpring: others have no nap"
    for part in (upright, fx.bristles.Homothetic(1.0), RIGHT.replace(angle=0.0)):
        with pytest.raises(
            ValueError, match=f"bristle = '{type(part).__name__}': {message}"
        ):
            fx.Target.of_nap(part, 0.05, 0.09)
    for values, named in (((-1.0, 0.1), "with_nap = -1"), ((0.1, 0.0), "against_nap = 0")):
        with pytest.raises(ValueError, match=f"{named}.*: needs .* > 0 in N"):
            fx.Target.of_nap(RIGHT, *values)
    with pytest.raises(ValueError, match=r"bristle = 'str': needs a part of frictionjax"):
        fx.Target.of_nap("rod", 0.1, 0.1)


def test_a_free_angle_must_not_turn_the_nap_round():
    for part, bounds in ((RIGHT, (-0.5, 0.5)), (LEFT, (-0.5, 0.1))):
        target = fx.Target.of_nap(part, 0.05, 0.09)
        known = {"free": "angle", "bounds": {"angle": bounds}}
        with pytest.raises(
            ValueError, match=r"bounds of 'angle' = .*: needs the nap on its"
        ):
            fx.fit_profile(target, **known)


def test_rods_that_turn_over_tell_their_window():
    """Friction asked for is that of the rod as it stands; turned over it is another one."""
    target = fx.Target.of_nap(ANGULAR, with_nap=0.12, against_nap=0.5)
    soft, right, stiff = (
        fx.fit_profile(target, effects=(fx.effects.NapFlip(stiffness),))
        for stiffness in (0.05, 0.1, 0.3)
    )
    turns = [fit.naps[0].turns_over for fit in (soft, right, stiff)]
    assert turns == [False, True, False]
    assert "it buckles against the nap, and again once turned over" in soft.message
    assert "it turns over, and friction is rho_with and rho_flipped" in right.message
    assert "it stays as it stands" in stiff.message
    window = right.naps[0].window
    parts = fx.supports.Spring(1.0), fx.loads.Triangle(3.0, 4.0), 4.0
    effects = (fx.effects.NapFlip(0.1),)
    scene = fx.Scene(right.profile, ANGULAR, *parts, effects=effects)
    assert window.least < np.pi**2 * 0.1 / 2 < window.greatest
    limit = fx.solve_limit(scene, [1.0, 3.0])
    force = 3.0 * np.array([1.0, -1.0]) - np.asarray(limit.z)
    flipped = right.naps[0].rho_flipped
    np.testing.assert_allclose(force, [0.12, -flipped], rtol=1e-6)
    assert list(limit.mode) == [1, -1]


def test_a_window_need_not_be_there():
    flip = (fx.effects.NapFlip(0.1),)
    fit = fx.fit_profile(fx.Target.of_nap(ANGULAR, 0.05, 0.06), effects=flip)
    assert fit.success
    assert fit.naps[0].window is None
    assert "no critical load turns it over against the nap and only then" in fit.message
    again = type(fit).from_json(fit.to_json())
    assert again.message == fit.message
    assert again.naps[0].message == fit.naps[0].message


def test_angles_of_rods_that_turn_over_tell_it_too():
    surface = fx.profiles.Sine(0.5)
    fit = fx.fit_angle(surface, ANGULAR, ratio=0.3, effects=(fx.effects.NapFlip(0.1),))
    assert fit.nap.turns_over
    assert "it turns over, and friction is rho_with and rho_flipped" in fit.message
    assert fit.nap.rho_with / fit.nap.rho_against == pytest.approx(0.3, rel=1e-12)
    with pytest.raises(ValueError, match="needs an AngularSpring"):
        fx.fit_angle(surface, RIGHT, ratio=0.3, effects=(fx.effects.NapFlip(0.1),))
