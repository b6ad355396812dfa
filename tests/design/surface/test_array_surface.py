"""Surfaces under upright tips at phases of their own: met, least bent, or told why not."""

import numpy as np
import pytest
from samples import central
from scipy.optimize import nnls

import frictionjax as fx
from frictionjax.design.surface.array_surface import fit_to_array, ratio_seen
from frictionjax.design.surface.exchange import SeenSlopes, bumps, shares_seen
from frictionjax.design.surface.fit import surface_problem
from frictionjax.design.surface.status import ProfileStatus

VERTICAL = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
APART = fx.effects.RigidArray([0.0, 0.1, 0.45], [1.0, 2.0, 0.5])
MANY = fx.effects.RigidArray(np.random.default_rng(1).uniform(-3, 3, size=20))


def friction_of(profile, effect, bristle=VERTICAL):
    parts = fx.supports.Spring(1.0), fx.loads.Ramp(1.0, 0.0)
    law = fx.friction(fx.Scene(profile, bristle, *parts, 1.0, effects=(effect,)))
    return float(law.rho_plus), float(law.rho_minus)


def fitted(plus, minus, effect, **options):
    return fx.fit_profile(fx.Target(VERTICAL, plus, minus), effects=(effect,), **options)


def brute_force(offsets, weights, plus, minus, harmonics, places=60, points=600):
    """Least `int w''^2` over the places of the lowest slope seen, all of them tried.

    Over cosines and sines of w itself, of whose slopes tips see the weighted sum: rows by
    adding up tips, nothing turned.
    """
    n = 2 * np.pi * np.arange(1, harmonics + 1)

    def rows(y):
        phase = n * (y[:, None, None] + np.reshape(offsets, (-1, 1)))
        waves = np.concatenate([np.cos(phase), np.sin(phase)], axis=-1)
        size = np.sqrt(2) / np.concatenate([n, n])
        return np.einsum("i,yin->yn", weights, waves) * size

    grid = rows(np.arange(points) / points)
    ends = np.concatenate([[plus, minus], np.full(points, -plus), np.full(points, -minus)])
    least = np.inf
    for low in np.arange(1, places) / places:
        fixed = rows(np.array([0.0, low])) * [[1.0], [-1.0]]
        stacked = np.concatenate([fixed, -grid, grid])
        both = np.concatenate([stacked.T, ends[None]])
        aim = np.zeros(len(both))
        aim[-1] = 1.0
        left = both @ nnls(both, aim, maxiter=100 * len(ends))[0] - aim
        if abs(left[-1]) > 1e-12:
            waves = -left[:-1] / left[-1]
            least = min(least, waves @ waves)
    return least


@pytest.mark.parametrize("ratio", [1.0, 1.5, 3.0, 8.0, 1 / 3])
@pytest.mark.parametrize("effect", [APART, MANY], ids=["three", "twenty"])
def test_friction_of_the_scene_is_what_was_asked_for(effect, ratio):
    fit = fitted(0.2 * ratio, -0.2, effect)
    assert fit.status is ProfileStatus.MET
    found = friction_of(fit.profile, effect)
    np.testing.assert_allclose(found, (0.2 * ratio, -0.2), rtol=1e-12)
    np.testing.assert_allclose(fit.residuals, 0.0, atol=1e-12)
    # A lower bound, but for what the last digits change; met but for what they cost.
    assert fit.bending_bound <= fit.bending_energy * (1 + 1e-9)
    assert fit.bending_energy <= fit.bending_bound * (1 + 1e-4)


@pytest.mark.parametrize("ratio", [1.5, pytest.param(3.0, marks=pytest.mark.slow)])
def test_tips_almost_at_one_phase_ask_for_what_one_asks_for(ratio):
    """Of one: a closed form; beyond what it holds for, a barrier that asks for the lowest
    slope half a period from the highest, where ripples of the optimum do not touch it."""
    one = fx.fit_profile(fx.Target(VERTICAL, 0.1 * ratio, -0.1))
    fit = fitted(0.2 * ratio, -0.2, fx.effects.RigidArray([0.0, 1e-6]))
    assert fit.bending_energy <= one.bending_energy * (1 + 1e-9)
    assert fit.bending_energy >= one.bending_bound * (1 - 2e-4)
    if ratio == 1.5:
        y = np.linspace(0, 1, 9)
        np.testing.assert_allclose(fit.profile(y), one.profile(y), atol=1e-6)


def test_two_tips_half_a_period_apart_ask_for_a_surface_of_half_the_period():
    """They see even waves only: half as many, of a surface twice as short."""
    one = fx.fit_profile(fx.Target(VERTICAL, 0.15, -0.1), harmonics=8)
    fit = fitted(0.3, -0.2, fx.effects.RigidArray([0.0, 0.5]))
    # w(y) = v(2 y)/2 has the slopes of v, and twice its curvature.
    assert fit.bending_energy == pytest.approx(4 * one.bending_energy, rel=1e-9)
    np.testing.assert_allclose(fit.profile.cos[0::2], 0.0, atol=1e-15)
    np.testing.assert_allclose(fit.profile.sin[0::2], 0.0, atol=1e-15)


@pytest.mark.parametrize(
    ("ratio", "weights"), [(1.0, (1, 1, 1)), (1.4, (1, 1, 1)), (2.5, (1, 2, 0.5))]
)
def test_no_surface_is_less_bent(ratio, weights):
    """Of three tips of one weight the lowest slope is best about a quarter away."""
    offsets, weights = np.array([0.0, 0.1, 0.45]), np.array(weights, float)
    effect = fx.effects.RigidArray(offsets, weights)
    fit = fitted(0.2 * ratio, -0.2, effect, harmonics=5)
    least = brute_force(offsets, weights, 0.2 * ratio, 0.2, 5)
    # Its places are 1/60 apart, so it is above; its range holds on rows only, so below.
    assert least * (1 - 1e-2) <= fit.bending_energy <= least * (1 + 1e-3)


def test_more_waves_bend_less():
    few, many = (fitted(0.5, -0.2, APART, harmonics=n).bending_energy for n in (5, 16))
    assert few > many > 0.5 * few


def test_pulling_bristles_swap_the_ends():
    part = fx.bristles.Homothetic(-2.0)
    target = fx.Target(part, 0.5, -0.2)
    fit = fx.fit_profile(target, effects=(APART,), pulling=True)
    found = friction_of(fit.profile, APART, part)
    np.testing.assert_allclose(found, (0.5, -0.2), rtol=1e-12)


@pytest.mark.parametrize("turned", [False, True])
def test_ratios_that_no_surface_has_are_told(turned):
    """Three tips spread evenly see every third wave: five of 16, so ratios up to 5."""
    thirds = fx.effects.RigidArray(np.arange(3) / 3)
    pair = (0.2, -1.6) if turned else (1.6, -0.2)
    fit = fitted(*pair, thirds)
    assert fit.status is ProfileStatus.TOO_FEW_HARMONICS
    found = friction_of(fit.profile, thirds)
    ratio = max(found[0], -found[1]) / min(found[0], -found[1])
    assert 4.95 < ratio < 5 * (1 + 1e-9)
    law = fit.coefficients[0]
    np.testing.assert_allclose([law.rho_plus, law.rho_minus], found, rtol=1e-12)
    assert "from 1/4.9" in fit.message
    assert "asked for: 8" in fit.message.replace("0.125", "8")
    # The nearest: relative errors stand as the ends of the boundary let them.
    errors = np.array(found) / pair - 1
    high = 1 if turned else 0
    assert errors[high] < 0 < errors[1 - high]
    share = ratio / 8
    best = (share + 1) / (share**2 + 1)
    assert errors[1 - high] == pytest.approx(best - 1, rel=1e-6)


@pytest.mark.slow
def test_random_arrays_end_at_what_a_surface_has():
    """Met where some surface has the ratio, whatever the phases; nothing is lost else."""
    draw, met = np.random.default_rng(5), 0
    for _ in range(200):
        count, harmonics = int(draw.integers(2, 40)), int(draw.integers(1, 25))
        grid = draw.integers(2, 7)  # places that waves divide, or anywhere
        offsets = draw.uniform(-5, 5, count)
        offsets = offsets if draw.random() < 0.7 else np.round(offsets * grid) / grid
        effect = fx.effects.RigidArray(offsets, draw.uniform(0, 2, count))
        ratio = float(np.exp(draw.uniform(-3.4, 3.4)))
        target = fx.Target(VERTICAL, np.sqrt(ratio), -np.sqrt(1 / ratio))
        problem = surface_problem(target, harmonics, effects=(effect,))
        if problem.asked.apart is None:
            continue
        found = fit_to_array(problem.layout, problem.task, effect, 1)
        if found.settled.met[0]:
            met += 1
            np.testing.assert_allclose(found.settled.residuals[0], 0.0, atol=1e-11)
            energy = np.sum(found.settled.waves[0] ** 2)
            assert energy <= found.bound[0] * (1 + 1e-3)
        else:
            assert max(ratio, 1 / ratio) >= ratio_seen(effect, harmonics)
    assert met > 100


def test_targets_that_contradict_each_other_are_weighed():
    """Slopes of least squares, as all bristles are linear in them."""
    other = fx.bristles.Homothetic(2.0)
    targets = [fx.Target(VERTICAL, 0.3, -0.1), fx.Target(other, 0.5, -0.2, weight=3.0)]
    fit = fx.fit_profile(targets, effects=(APART,))
    assert fit.status is ProfileStatus.CONTRADICTORY
    asked, weights = np.array([0.3, 0.25]), np.array([1 / 0.3**2, 3 / 0.25**2])
    slope = np.sum(weights * asked) / np.sum(weights)
    found = friction_of(fit.profile, APART)
    np.testing.assert_allclose(found, (slope, -0.1), rtol=1e-12)


def test_what_is_seen_is_the_sum_of_the_tips():
    shares = shares_seen(MANY, 7)
    offsets = np.asarray(MANY.offsets)
    n = np.arange(1, 8)
    wanted = np.exp(2j * np.pi * offsets[:, None] * n).sum(axis=0)
    np.testing.assert_allclose(shares, wanted, rtol=1e-11)
    even = shares_seen(fx.effects.RigidArray(np.arange(4) / 4), 8)
    np.testing.assert_allclose(even, [0, 0, 0, 4, 0, 0, 0, 4], atol=1e-15)
    assert np.count_nonzero(even) == 2


def test_all_bumps_are_found():
    seen = SeenSlopes(9, np.tile(np.linspace(1.0, 0.2, 9), 2))
    waves = np.random.default_rng(3).standard_normal(18)
    places, slopes = bumps(seen, waves)
    dense = seen.at(np.linspace(0, 1, 200_001)) @ waves
    assert np.max(slopes) == pytest.approx(np.max(dense), rel=1e-9)
    assert np.min(slopes) == pytest.approx(np.min(dense), rel=1e-9)
    best = places[np.argmax(slopes)]
    assert abs(seen.at(best, 1) @ waves) < 1e-10 * np.max(np.abs(seen.at(0.0, 1)))


def test_what_coefficients_see_are_finite_differences():
    fit = fitted(0.24, -0.2, APART)
    seen = fit.identifiability
    assert seen.rank == 2
    for name, wave, column in (("cos", 3, 3), ("sin", 0, 16)):

        def log_friction(value, name=name, wave=wave):
            row = np.asarray(getattr(fit.profile, name)).copy()
            row[wave] = value
            found = friction_of(fit.profile.replace(**{name: row}), APART)
            return np.log(np.abs(found))

        own = float(getattr(fit.profile, name)[wave])
        slopes = central(log_friction, own, 1e-7)
        np.testing.assert_allclose(seen.sensitivities[:, column], slopes, rtol=1e-4)


def test_other_surfaces_have_the_same_friction():
    fit = fitted(0.6, -0.2, APART)
    others = fit.family(3)
    assert len(others) == 3
    for other in others:
        np.testing.assert_allclose(friction_of(other, APART), (0.6, -0.2), rtol=1e-11)
        assert fx.design.surface.barrier.bending_energy(other.cos, other.sin) > (
            1.01 * fit.bending_energy
        )
    title = "Slopes: tips on one root see a sum of them"
    assert title in [axes.get_title(loc="left") for axes in fit.plot().axes]
    again = type(fit).from_json(fit.to_json())
    assert again.identifiability.rank == 2
    np.testing.assert_array_equal(again.family(1)[0].cos, others[0].cos)
