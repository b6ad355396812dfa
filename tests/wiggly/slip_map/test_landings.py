"""How soon tips on slow slides are half a well beyond a fold, against trajectories."""

import numpy as np
import pytest
from landings_unknown import without_landings
from paths import path_of
from scipy.integrate import quad

import frictionjax as fx
from frictionjax._checks import viscosity_of
from frictionjax.model import tabulated_scene
from frictionjax.wiggly.plan import planned
from frictionjax.wiggly.slip_map import latest_landings, steady_lags, wells_both_ways

SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
ANGULAR = fx.bristles.AngularSpring(1.0, 1.414, 1.0, 0.3)
VERTICAL = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
TWO_FOLDS = fx.profiles.Fourier([0.0, 0.0024, 0.0, 0.0012], [0.0096, 0.0, -0.0024, 0.0006])
NEARLY_ALIKE = fx.profiles.Fourier([0.0003, 0.0], [0.0003, 0.012])
PULL = fx.loads.Sine(1.0, 3.0)
PARTS = {
    "sine": (fx.profiles.Sine(0.1), VERTICAL),
    "slanted": (fx.profiles.Sine(0.1), SLANTED),
    "two folds": (TWO_FOLDS, ANGULAR),
    "nearly alike": (NEARLY_ALIKE, VERTICAL),
}


def scene_of(name, rate):
    """One slide at one speed."""
    profile, bristle = PARTS[name]
    load = fx.loads.PiecewiseLinear([0.0, 3.0], [0.0, rate])
    return fx.Scene(profile, bristle, fx.supports.Spring(1.3), load, 3.0)


@pytest.mark.parametrize("rate", [2.0, -2.0], ids=["right", "left"])
@pytest.mark.parametrize(
    ("name", "eps", "gamma", "sharp"),
    [
        ("sine", 1e-4, 1.0, 1.3),
        ("slanted", 1e-3, 1.0, 1.3),
        ("two folds", 2e-4, 1.0, 1.3),
        ("nearly alike", 5e-5, 1.0, 1.3),
    ],
)
def test_tips_are_half_a_well_further_by_then_and_not_long_before(
    name, eps, gamma, sharp, rate
):
    scene, way = scene_of(name, rate), int(rate < 0)
    tables, path = tabulated_scene(scene, eps), path_of(scene)
    cell = np.array([eps]), np.array([gamma])
    plan = planned(tables, path, *cell, 3, 1e-3, "auto")
    ground, folds = plan.ground, plan.ground.folds
    landed = ground.landed[0, way]
    assert 0.02 < landed < 0.45
    fold = (folds.state_plus, folds.state_minus)[way][0]
    place = (folds.place_plus, folds.place_minus)[way][0]
    force = (folds.force_plus, folds.force_minus)[way][0]
    sign, stiffness, speed = np.sign(rate), 1.3, 2.0 / 3 / 1.3

    def stretch(y):
        return float(tables.potential.tip_force(y, eps)[1])

    half = abs(quad(stretch, place, place + 0.5 * sign)[0])
    # The load at which the path comes to the fold of a well, in the middle of the slide.
    wells = np.arange(5) + np.ceil(sign * (0.5 - fold) / eps if way == 0 else 0.5 / eps)
    level = force + stiffness * (fold + sign * wells * eps)
    at_fold = level / (rate / 3.0)
    period = eps / speed

    def beyond(late):
        """Wells between tips and the places half a well beyond their folds."""
        times = at_fold + late * period
        with without_landings():
            solution = fx.solve(scene, eps, gamma, times, 1e-5)
        assert solution.ok
        return sign * (np.asarray(solution.z) - fold) / eps - wells - half

    assert beyond(landed).min() > 0
    assert beyond(landed / sharp).max() < 0


def test_fast_slides_and_folds_alike_have_no_landings():
    """Two folds as high as each other: the tip rests in both halves of a well."""
    eps, drag = np.array([1e-4]), np.array([0.6 * 1e-4])
    alike = fx.profiles.Fourier([0.0, 0.0], [0.0, 0.012])
    for profile, viscous in ((alike, drag), (fx.profiles.Sine(0.1), 1e3 * drag)):
        assert np.all(np.isinf(landings_of(profile, eps, viscous, 1.3)))


def landings_of(profile, eps, drag, softest=1.0, stiffest=None):
    """Of a vertical bristle, both ways."""
    scene = fx.Scene(profile, VERTICAL, fx.supports.Spring(1.0), PULL, 3.0)
    tables = tabulated_scene(scene, eps)
    plan = planned(tables, path_of(scene), eps, np.ones(1), 3, 1e-3, "auto")
    wells = wells_both_ways(tables.potential, eps, plan.ground.folds)
    pulls = softest * eps, (stiffest or softest) * eps
    lag = steady_lags(wells, drag).force / pulls[0]
    return latest_landings(wells, lag, drag, *pulls)


def test_a_mirrored_surface_swaps_the_sides():
    """Of folds that fall off more on one side than on the other."""
    eps, drag = np.array([1e-2]), np.array([2e-4])
    saw = fx.profiles.Fourier([0.002, 0.001, 0.0], [0.012, 0.004, 0.001])
    mirrored = saw.replace(sin=-saw.sin)
    found, swapped = landings_of(saw, eps, drag), landings_of(mirrored, eps, drag)
    assert np.all(np.isfinite(found))
    assert abs(found[0] / found[1] - 1) > 1e-2
    np.testing.assert_allclose(found, swapped[::-1], rtol=1e-6)


def two_bumps(lower, width=0.012, apart=0.47):
    """`w'` has two bumps, one a little lower, both narrower than the grid is there."""
    n = np.arange(1, 49)
    slopes = np.exp(-2 * (np.pi * n * width) ** 2)
    slopes = 0.05 * slopes / slopes.sum()
    waves = slopes / (2j * np.pi * n) * (1 + lower * np.exp(-2j * np.pi * n * apart))
    return fx.profiles.Fourier(2 * waves.real, -2 * waves.imag)


def test_a_narrow_second_fold_is_not_stepped_over():
    """Tips wait at it, between two places of the grid."""
    eps, drag = np.array([1e-5]), np.array([3e-6])
    alone, second = two_bumps(lower=0.5), two_bumps(lower=0.9999)
    assert np.all(
        landings_of(second, eps, drag)[0] > 1.2 * landings_of(alone, eps, drag)[0]
    )


@pytest.mark.parametrize("drag", [1e-9, 1e-8])
def test_landings_near_a_fold_are_those_of_airys_equation(drag):
    """Riccati's, `drag dY/ds = k s + c Y^2 / 2`, blows up at Airy's first zero."""
    eps, profile = 1e-6, fx.profiles.Sine(0.1)
    found = landings_of(profile, np.array([eps]), np.array([drag]))
    curvature = (2 * np.pi) ** 2 * float(fx.friction(profile, VERTICAL).rho_plus)
    airy = 2.3381 * np.cbrt(2 * drag**2 / (eps * curvature))
    # The least force of each stretch in place of the force: a bound from above.
    assert found / airy == pytest.approx(1.13, abs=0.02)


@pytest.mark.parametrize("phase", [0.0, 0.1, 0.7])
@pytest.mark.parametrize("share", [0.0, 1e-6])
def test_folds_nearly_alike_have_no_landings(phase, share):
    """Wherever samples are: tips rest at each of the three."""
    wave = 0.008 * np.exp(2j * np.pi * np.array([0.0, 0.0, phase])) * [share, 0.0, 1.0]
    profile = fx.profiles.Fourier(wave.real, wave.imag)
    found = landings_of(profile, np.array([1e-6]), np.array([6e-7]))
    assert np.all(np.isinf(found))


def test_supports_that_stiffen_land_later():
    """The least pull before a fold, the most while the tip is let go."""
    cell = fx.profiles.Sine(0.1), np.array([1e-3]), viscosity_of(np.array([1e-3]), 1.5)
    plain = landings_of(*cell)
    assert np.all(landings_of(*cell, softest=0.5, stiffest=1.0) > 1.2 * plain)
    assert np.all(landings_of(*cell, stiffest=20.0) > plain)
