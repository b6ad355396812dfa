"""What `fit_profile` refuses, cannot reach, or does not finish."""

import re

import jax
import numpy as np
import pytest
from designs import ANGULAR, HOMOTHETIC, SLANTED, slopes_of

import frictionjax as fx
from frictionjax.design.surface.status import ProfileStatus

# Bounds that are not felt: by the program of fits with bounds.
UNFELT = {"largest_amplitude": 10.0, "smallest_radius": 1e-3}


def descended(target):
    return fx.fit_profile(target, harmonics=4, starts=2, **UNFELT)


UNREACHABLE = [
    # mu_plus < cot/(1 + cot^2) = sin cos of theta_lim, alpha = 0.573
    (ANGULAR, 0.5, -0.1, {}, ProfileStatus.INADMISSIBLE, "rho_plus < 0.284919 N"),
    (HOMOTHETIC, 3.0, -0.1, {}, ProfileStatus.TOO_FEW_HARMONICS, "asked for: 30"),
    (HOMOTHETIC, 3.0, -0.1, UNFELT, ProfileStatus.TOO_FEW_HARMONICS, "asked for: 30"),
    (ANGULAR, 0.5, -0.1, UNFELT, ProfileStatus.INADMISSIBLE, "rho_plus < 0.284919 N"),
    (
        HOMOTHETIC,
        0.3,
        -0.1,
        {"smallest_radius": 2.0, "largest_amplitude": 10.0},
        ProfileStatus.TOO_SHARP,
        "0.2754 of the slopes asked for",
    ),
    (
        HOMOTHETIC,
        0.3,
        -0.1,
        {"largest_amplitude": 0.005, "smallest_radius": 1e-4},
        ProfileStatus.TOO_HIGH,
        "of the slopes asked for, 0.3 and -0.1",
    ),
]


@pytest.mark.parametrize(
    ("part", "plus", "minus", "bounds", "status", "said"),
    [
        u if u[3] is UNFELT else pytest.param(*u, marks=pytest.mark.slow)
        for u in UNREACHABLE
    ],
)
def test_unreachable_targets_say_what_is_reachable(part, plus, minus, bounds, status, said):
    harmonics = 4 if bounds is UNFELT else 16
    fit = fx.fit_profile(fx.Target(part, plus, minus), harmonics, starts=2, **bounds)
    assert fit.status is status
    assert not fit.success
    assert said in fit.message
    assert 0 < fit.coefficients[0].rho_plus < plus
    if bounds:
        steepest = np.max(np.abs(slopes_of(fit.profile, order=1)))
        assert steepest <= 1 / bounds["smallest_radius"]
        heights = slopes_of(fit.profile, order=-1)
        assert np.ptp(heights) <= bounds["largest_amplitude"]


STEEP = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)


@pytest.mark.slow  # a program of its own
def test_what_is_within_reach_and_not_found_is_not_called_out_of_it():
    """1e5 N are met; at 1e6 slopes are within 1e-6 of those that the bristle can follow."""
    fit = fx.fit_profile(fx.Target(STEEP, 1e6, -0.05), starts=2)
    assert fit.status is ProfileStatus.NOT_FOUND
    assert not fit.success
    assert "(asked for: 12.05" in fit.message


def test_slopes_no_bristle_follows_are_told_from_too_few_harmonics():
    """rho_minus below its limit at any number of harmonics; a ratio that more meet."""
    beyond = descended(fx.Target(STEEP, 0.12, -0.7))
    assert beyond.status is ProfileStatus.INADMISSIBLE
    assert "rho_minus > -0.652647 N" in beyond.message
    assert "asked for" not in beyond.message  # no slope gives it
    uneven = fx.Target(STEEP, 5.0, -0.01)
    few = descended(uneven)
    assert few.status is ProfileStatus.TOO_FEW_HARMONICS
    assert "asked for: 56.8449" in few.message


@pytest.mark.slow
def test_the_reachable_share_is_reached_and_no_more():
    said = 0.275492
    bounds = {"smallest_radius": 2.0, "largest_amplitude": 10.0}
    for share, success in ((0.98, True), (1.02, False)):
        target = fx.Target(HOMOTHETIC, 0.3 * said * share, -0.1 * said * share)
        assert fx.fit_profile(target, starts=2, **bounds).success == success


def test_a_ratio_of_the_number_of_harmonics_is_the_limit():
    """Fejer: a non-negative series of N harmonics is N + 1 times its mean at most."""
    near = fx.fit_profile(fx.Target(HOMOTHETIC, 0.97 * 16, -1.0), starts=2)
    assert near.success
    assert descended(fx.Target(HOMOTHETIC, 0.97 * 4, -1.0)).success
    beyond = descended(fx.Target(HOMOTHETIC, 1.03 * 4, -1.0))
    assert beyond.status is ProfileStatus.TOO_FEW_HARMONICS


@pytest.mark.slow
def test_reach_with_free_numbers_is_that_of_all_bristles_in_the_bounds():
    """sin cos theta_lim alpha(theta_lim) is largest at 0.9 there, not where it ended."""
    rod = fx.bristles.AngularSpring(1.0, 1.414, 1.0, 0.3)
    target, bounds = fx.Target(rod, 0.3, -0.05), {"angle": (0.4, 0.9)}
    fit = fx.fit_profile(target, starts=2, free="angle", bounds=bounds)
    assert fit.status is ProfileStatus.INADMISSIBLE
    told = float(re.search(r"rho_plus < ([\d.]+) N", fit.message)[1])
    closed_form = 1.0 * (0.9 - 0.3) * np.cos(0.9) / 1.414
    assert closed_form - 2e-6 < told < closed_form


BAD = [
    ([], r"targets = '\[\]': needs at least one Target"),
    (3.0, "targets = 'float'"),
    ([3.0], r"targets\[0\] = 'float'"),
    (fx.Target(3.0, 1.0, -1.0), "target.bristle = 'float'"),
    (fx.Target(HOMOTHETIC, -1.0, -1.0), "target.rho_plus = -1: needs rho_plus > 0"),
    (fx.Target(HOMOTHETIC, 0.0, -1.0), "target.rho_plus = 0: needs rho_plus > 0"),
    (fx.Target(HOMOTHETIC, 1.0, 1.0), "target.rho_minus = 1: needs rho_minus < 0"),
    (fx.Target(HOMOTHETIC, np.nan, -1.0), "target.rho_plus = nan: needs a finite"),
    (fx.Target(HOMOTHETIC, 1.0, -np.inf), "target.rho_minus = -inf: needs a finite"),
    (fx.Target(HOMOTHETIC, [1.0, 2.0], -1.0), r"target.rho_plus = \[1. 2.\]: needs one"),
    (fx.Target(HOMOTHETIC, True, -1.0), "target.rho_plus = True: needs a number"),
    (fx.Target(HOMOTHETIC, "high", -1.0), "target.rho_plus = 'high': needs a number"),
    (fx.Target(HOMOTHETIC, 1.0, -1.0, 0.0), "target.weight = 0: needs weight > 0"),
    (fx.Target(HOMOTHETIC, 1.0, -1.0, -1.0), "target.weight = -1: needs weight > 0"),
    (fx.Target(HOMOTHETIC, 1.0, -1.0, 1.0, 0.0), "target.uncertainty = 0: needs one"),
    (fx.Target(HOMOTHETIC, 1.0, -1.0, 1.0, [1, 2, 3]), "target.uncertainty = "),
    (
        [fx.Target(HOMOTHETIC, 1.0, -1.0), fx.Target(HOMOTHETIC, 1.0, -1.0, 1.0, 0.1)],
        "uncertainty = None: needs one for every target or for none",
    ),
    (
        [fx.Target(HOMOTHETIC, 1.0, -1.0), fx.Target(HOMOTHETIC, 1.0, -1.0, 0.0)],
        r"targets\[1\].weight = 0",
    ),
    (
        fx.Target(fx.bristles.VerticalSpring(1.0, 1.0, 1.0), 1.0, -1.0),
        "target.bristle: alpha = 0: needs alpha",
    ),
]


@pytest.mark.parametrize(("targets", "message"), BAD)
def test_bad_targets_have_their_own_errors(targets, message):
    with pytest.raises(ValueError, match=message):
        fx.fit_profile(targets)


GOOD = fx.Target(SLANTED, 0.15, -0.1)
BAD_ARGUMENTS = [
    ({"harmonics": 0}, "harmonics = 0: needs a whole number >= 1"),
    ({"harmonics": 2.5}, "harmonics = 2.5: needs a whole number >= 1"),
    ({"starts": 0}, "starts = 0: needs a whole number >= 1"),
    ({"seed": 1.5}, "seed = 1.5: needs a whole number >= 0"),
    ({"max_steps": 0}, "max_steps = 0: needs a whole number >= 1"),
    ({"smallest_radius": 0.0}, "smallest_radius = 0: needs smallest_radius > 0"),
    ({"smallest_radius": np.nan}, "smallest_radius = nan"),
    ({"largest_amplitude": -1.0}, "largest_amplitude = -1: needs largest_amplitude > 0"),
    ({"free": ["angle"]}, r"bounds = 'none': needs bounds = {'angle': \(low"),
    ({"bounds": {"angle": (0, 1)}}, r"bounds = 'angle': needs names in free = \[\]"),
    ({"free": ["size"], "bounds": {"size": (0, 1)}}, "free = 'size': needs one of"),
    ({"free": "angle", "bounds": {"angle": (0.6, 0.9)}}, "bounds of 'angle' = "),
    ({"free": "angle", "bounds": {"angle": (0.1, 1.8)}}, r"a part of \(-1.5708, 1.5708\)"),
    ({"free": "height", "bounds": {"height": (-5, 1.1)}}, r"a part of \(0, inf\)"),
    ({"free": 5}, "free = '5': needs a name or a list of names"),
    ({"free": ["angle", "angle"]}, "needs every name once"),
    ({"bounds": 3}, "bounds = 3: needs a mapping from names"),
    ({"free": "angle", "bounds": {"angle": (0.9, 0.1)}}, "bounds of 'angle' = .*a pair"),
]


@pytest.mark.parametrize(("arguments", "message"), BAD_ARGUMENTS)
def test_bad_arguments_have_their_own_errors(arguments, message):
    with pytest.raises(ValueError, match=message):
        fx.fit_profile(GOOD, **arguments)


def test_32_bits_are_refused():
    with jax.enable_x64(False), pytest.raises(ValueError, match="jax_enable_x64"):
        fx.fit_profile(GOOD)


def test_a_short_budget_says_so():
    differ = [fx.Target(GOOD.bristle, plus, -0.1) for plus in (0.3, 0.31)]  # in no step
    fit = fx.fit_profile(differ, starts=2, max_steps=5, harmonics=4)
    assert fit.status is ProfileStatus.MAX_STEPS
    assert not fit.success
    assert fit.history.loss.shape == (2, 5)
