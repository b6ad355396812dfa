"""Surfaces for given friction coefficients: met, least bent, bounded, honest if not."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from designs import ANGULAR, HOMOTHETIC, SLANTED, slopes_of
from samples import BRISTLES, bristle
from scipy.optimize import nnls

import frictionjax as fx
from frictionjax.design.common.targets import geometry
from frictionjax.design.surface.barrier.bending import free_energy, kernel_ratio
from frictionjax.design.surface.barrier.constraints import heights_of_waves
from frictionjax.design.surface.fit import surface_problem
from frictionjax.design.surface.multistart import multistart
from frictionjax.design.surface.report import _series
from frictionjax.design.surface.settings import SETTINGS
from frictionjax.design.surface.status import ProfileStatus

# Bounds on surfaces are a program for each number of harmonics: all by one.
BOUNDED = {"harmonics": 4, "starts": 2}


class Rows(NamedTuple):
    """Fourier coefficients of many surfaces."""

    cos: np.ndarray
    sin: np.ndarray


def quadratic_program(plus, minus, harmonics, bend=np.inf, half=True, points=1501):
    """Least `int v'^2` of even v with v(0) = plus, -minus <= v <= plus.

    `half`: and v(1/2) = -minus. A least-distance problem solved as Lawson and Hanson do, on
    rows far denser than the library's: independent of it.
    """
    n = np.arange(1, harmonics + 1)
    y = np.linspace(0, 0.5, points)
    size = np.sqrt(2) / (2 * np.pi * n)
    rows = size * np.cos(2 * np.pi * np.outer(y, n))
    blocks, ends = [rows[:1], -rows[:1], rows, -rows, -rows[-1:]], [[plus], [-plus]]
    ends += [np.full(points, -minus), np.full(points, -plus), [minus if half else -plus]]
    if np.isfinite(bend):
        curved = np.sqrt(2) * np.sin(2 * np.pi * np.outer(y, n))
        blocks += [curved, -curved]
        ends += [np.full(points, -bend), np.full(points, -bend)]
    stacked = np.concatenate([np.concatenate(blocks).T, np.concatenate(ends)[None]])
    aim = np.zeros(harmonics + 1)
    aim[-1] = 1.0
    found, _ = nnls(stacked, aim, maxiter=100 * stacked.shape[1])
    left = stacked @ found - aim
    waves = -left[:-1] / left[-1]
    return float(waves @ waves)


def reachable_target(kind, rng):
    """A bristle of this kind and coefficients of slopes that it can follow."""
    part = bristle(kind, rng, rng.choice([-1, 1]))
    known = geometry(part)
    share, ratio = rng.uniform(0.02, 0.95), np.exp(rng.uniform(-2.3, 2.3))
    plus, minus = np.sqrt(ratio), np.sqrt(1 / ratio)
    widest = min(float(known.upper) / plus, -float(known.lower) / minus, 2.0)
    plus, minus = share * widest * plus, share * widest * minus
    a, alpha = float(known.a), float(known.alpha)
    pair = alpha * plus / (1 + a * plus), -alpha * minus / (1 - a * minus)
    return fx.Target(part, max(pair), min(pair))


def check_met(fit, target):
    assert fit.success
    assert fit.status is ProfileStatus.MET
    found = fx.friction(fit.profile, target.bristle)
    assert abs(found.rho_plus / target.rho_plus - 1) < 1e-9
    assert abs(found.rho_minus / target.rho_minus - 1) < 1e-9
    assert fit.largest_error < 1e-9
    # Admissible at every iterate: 1 + a omega > 0 and the bristle's own bounds.
    known = geometry(target.bristle)
    slopes = slopes_of(fit.history, points=512)
    assert np.nanmax(slopes) < float(known.upper)
    assert np.nanmin(slopes) > float(known.lower)
    assert fit.bending_bound <= fit.bending_energy * (1 + 1e-9)
    assert fit.bending_energy <= 1.01 * fit.bending_bound


@pytest.mark.slow
def test_a_plateau_of_bumps_that_hardly_bend():
    """Newton's steps alone left 4e-9 of the coefficient there, with status MET."""
    part = fx.bristles.SlantedSpring(1.79937389623384, 0.562861595867061, 1.0, 0.2835998986)
    target = fx.Target(part, 0.6710843956660764, -5.435253666816398)
    check_met(fx.fit_profile(target, pulling=True), target)


@pytest.mark.parametrize("kind", BRISTLES)
def test_random_reachable_targets(kind):
    rng = np.random.default_rng(7)
    for _ in range(5):
        target = reachable_target(kind, rng)
        check_met(fx.fit_profile(target, starts=2, pulling=True), target)


@pytest.mark.slow
@pytest.mark.parametrize("count", [40, 200])
def test_many_random_targets_of_every_bristle_at_once(count):
    """One batch of the compiled program, coefficients by Lemmas 2 and 3."""
    rng = np.random.default_rng(11)
    targets = [reachable_target(kind, rng) for kind in BRISTLES for _ in range(count)]
    problems = [surface_problem([target], pulling=True) for target in targets]
    layout = problems[0].layout
    tasks = jax.tree_util.tree_map(lambda *one: np.stack(one), *(p.task for p in problems))
    keys, shares = jax.random.split(jax.random.PRNGKey(0), 1), np.zeros((1, 0))
    half = np.array([0.5])
    fit = jax.vmap(
        lambda task: multistart(layout, 200, np.asarray(200), task, half, keys, shares)
    )
    runs = fit(tasks)
    assert np.all(runs.settled.met)
    assert np.all(runs.path.done)
    slope = np.asarray(tasks.slope)[:, None]
    waves = np.asarray(runs.settled.waves)[:, 0] * slope
    cos, sin = heights_of_waves(waves)
    slopes = slopes_of(Rows(cos, sin))
    for index, target in enumerate(targets):
        known = geometry(target.bristle)
        plus, minus = slopes[index].max(), slopes[index].min()
        mu = plus / (1 + known.a * plus), minus / (1 + known.a * minus)
        rho = sorted(float(known.alpha * value) for value in mu)
        np.testing.assert_allclose(rho, [target.rho_minus, target.rho_plus], rtol=1e-4)
        assert known.lower < minus < 0 < plus < known.upper
    left = np.asarray(runs.settled.residuals)
    assert np.max(np.abs(left)) < 1e-12


@pytest.mark.slow
@pytest.mark.parametrize("kind", BRISTLES)
def test_many_random_reachable_targets(kind):
    rng = np.random.default_rng(11)
    for _ in range(200):
        target = reachable_target(kind, rng)
        check_met(fx.fit_profile(target, pulling=True), target)


def test_round_trip_of_random_surfaces():
    rng = np.random.default_rng(3)
    turns = 2 * np.pi * np.arange(1, 17)
    for _ in range(8):
        cos, sin = rng.normal(size=(2, 16)) / turns**2
        worn = fx.profiles.Fourier(cos, sin)
        found = fx.friction(worn, SLANTED)
        target = fx.Target(SLANTED, found.rho_plus, found.rho_minus)
        fit = fx.fit_profile(target, starts=2)
        check_met(fit, target)
        assert abs(fit.coefficients[0].omega_plus / found.omega_plus - 1) < 1e-9
        assert abs(fit.coefficients[0].omega_minus / found.omega_minus - 1) < 1e-9
        # Nothing that has these coefficients bends less, the surface itself included.
        assert fit.bending_energy < 0.5 * np.sum(turns**4 * (cos**2 + sin**2))


@pytest.mark.parametrize("ratio", [0.2, 0.35, 0.5, 0.7, 1.0, 1.5, 1.9, 2.5, 4.0, 5.0])
def test_no_surface_bends_less(ratio):
    plus, minus = 0.3 * np.sqrt(ratio), 0.3 / np.sqrt(ratio)
    fit = fx.fit_profile(fx.Target(HOMOTHETIC, plus, -minus), starts=2)
    # Where the lowest slope is flattened, no place of it is asked for.
    free = max(ratio, 1 / ratio) < kernel_ratio(16)
    best = quadratic_program(max(plus, minus), min(plus, minus), 16, half=free)
    assert best * (1 - 1e-6) < fit.bending_energy < best * 1.001
    assert fit.bending_bound < best * (1 + 1e-6)
    if free:
        assert abs(free_energy(plus, minus, 16) / best - 1) < 1e-6
    else:
        assert free_energy(plus, minus, 16) < best * (1 - 1e-6)


@pytest.mark.slow
def test_no_surface_bends_less_within_a_bound_on_curvature():
    free = fx.fit_profile(fx.Target(HOMOTHETIC, 0.3, -0.15), starts=2)
    sharpest = np.max(np.abs(slopes_of(free.profile, order=1)))
    radius = 1 / (0.8 * sharpest)
    fit = fx.fit_profile(
        fx.Target(HOMOTHETIC, 0.3, -0.15),
        starts=2,
        smallest_radius=radius,
        largest_amplitude=10.0,  # not felt: one program for all tests with bounds
    )
    best = quadratic_program(0.3, 0.15, 16, bend=1 / radius)
    assert fit.success
    assert best > 1.01 * free.bending_energy
    assert best * (1 - 1e-6) < fit.bending_energy < 1.01 * best


def test_bounds_hold_at_every_iterate():
    target, radius, height = fx.Target(SLANTED, 0.3, -0.2), 0.25, 0.04
    bounds = {"smallest_radius": radius, "largest_amplitude": height}
    fit = fx.fit_profile(target, **bounds, **BOUNDED)
    assert fit.success
    known, history = geometry(SLANTED), fit.history
    slopes = slopes_of(history)
    assert np.nanmax(slopes) < known.upper
    assert np.nanmin(slopes) > known.lower
    assert np.nanmax(np.abs(slopes_of(history, order=1))) <= 1 / radius
    heights = slopes_of(history, order=-1)
    assert np.nanmax(np.ptp(heights, axis=-1)) <= height
    assert np.ptp(slopes_of(fit.profile, order=-1)) > 0.97 * height  # this one is felt
    # Bounds of the extreme slopes are what they say, on rows.
    assert np.nanmax(np.max(slopes, axis=-1) - history.omega_plus) < 1e-2
    rows = slopes_of(history, points=32 * BOUNDED["harmonics"])
    last = [np.flatnonzero(np.isfinite(row))[-1] for row in history.loss]
    for start, step in enumerate(last):
        assert history.omega_plus[start, step] >= np.max(rows[start, step]) - 1e-8


def test_starts_agree_where_theory_says_so():
    """Without bounds on the height the problem is convex: a flat waterfall.

    Of targets that differ, of which the slopes are found by the barrier; then a least
    distance, a start more, finds the surface that is flattened.
    """
    targets = [fx.Target(HOMOTHETIC, plus, -0.1) for plus in (0.3, 0.31)]
    fit = fx.fit_profile(targets, starts=2, harmonics=4)
    ran = [start.bending_energy for start in fit.starts[1:]]
    assert max(ran) / min(ran) < 1 + 1e-6
    assert 1.005 < min(ran) / fit.bending_energy < 1.01
    assert fit.bending_bound == pytest.approx(fit.bending_energy, rel=1e-4)
    assert fit.starts[0].number == 2
    assert sorted(start.number for start in fit.starts[1:]) == [0, 1]
    assert all(start.status is ProfileStatus.CONTRADICTORY for start in fit.starts)
    assert {start.place for start in fit.starts[1:]} == {0.5}


def test_a_bounded_height_has_local_optima():
    """Several bumps are lower: starts with the lowest slope elsewhere end elsewhere."""
    target = fx.Target(HOMOTHETIC, 0.3, -0.1)
    bounds = {"largest_amplitude": 0.04, "smallest_radius": 1e-3}
    fit = fx.fit_profile(target, **bounds, **BOUNDED)
    assert fit.success
    energies = [start.bending_energy for start in fit.starts]
    assert energies == sorted(energies)
    assert energies[-1] > 1.001 * energies[0]
    assert {start.place for start in fit.starts} == {0.5, 43 / 128}


def test_a_batch_of_starts_equals_each_alone():
    # With bounds that are not felt: by the program of the tests of bounds.
    target, unfelt = fx.Target(ANGULAR, 0.03, -0.1), {"radius": 1e-3, "amplitude": 10.0}
    problem = surface_problem([target], BOUNDED["harmonics"], **unfelt)
    keys, places = jax.random.split(jax.random.PRNGKey(5), 2), np.array([0.5, 0.375])
    known, shares = (problem.layout, SETTINGS.kept, np.asarray(200)), np.zeros((2, 0))
    batch = multistart(*known, problem.task, places, keys, shares)
    for i in range(2):
        twice = np.array([i, i])
        args = places[twice], keys[twice], shares
        alone = multistart(*known, problem.task, *args)
        np.testing.assert_allclose(
            batch.settled.waves[i], alone.settled.waves[i], rtol=0, atol=1e-9
        )
        assert batch.path.steps[i] == alone.path.steps[i]
    assert abs(batch.settled.waves[0] - batch.settled.waves[1]).max() > 1e-3


@pytest.mark.slow
def test_several_bristles_on_one_surface():
    cos, sin = np.zeros((2, 16))
    cos[:2], sin[:2] = [0.01, 0.002], [0.02, 0.003]
    worn = fx.profiles.Fourier(cos, sin)
    parts = (SLANTED, ANGULAR)
    found = [fx.friction(worn, part) for part in parts]
    targets = [
        fx.Target(part, f.rho_plus, f.rho_minus)
        for part, f in zip(parts, found, strict=True)
    ]
    fit = fx.fit_profile(targets, starts=2)
    assert fit.status is ProfileStatus.MET
    assert fit.largest_error < 1e-9
    assert fit.degrees_of_freedom == 2
    assert fit.rank == 2


@pytest.mark.slow
def test_contradictory_targets_give_the_best_compromise():
    """rho of a homothetic bristle is linear in the slopes: the weighted mean."""
    targets = [fx.Target(HOMOTHETIC, 0.3, -0.1), fx.Target(HOMOTHETIC, 0.2, -0.1, 3.0)]
    fit = fx.fit_profile(targets, starts=2)
    assert fit.status is ProfileStatus.CONTRADICTORY
    assert not fit.success
    weights = np.array([1 / 0.3**2, 3 / 0.2**2])
    mean = np.sum(weights * [0.3, 0.2]) / np.sum(weights)
    assert abs(fit.coefficients[0].omega_plus / mean - 1) < 1e-9
    chi2 = np.sum(weights * (mean - np.array([0.3, 0.2])) ** 2)
    assert abs(fit.chi2 / chi2 - 1) < 1e-8
    assert f"rms residual {np.sqrt(chi2 / 4):.3g}" in fit.message


@pytest.mark.slow  # fits of other bristles, a program of their own
def test_compromises_of_other_bristles_are_stationary():
    targets = [fx.Target(SLANTED, 0.3, -0.2), fx.Target(ANGULAR, 0.1, -0.1)]
    fit = fx.fit_profile(targets, starts=2)
    assert fit.status is ProfileStatus.CONTRADICTORY
    known = [geometry(target.bristle) for target in targets]

    def chi2(plus, minus):
        total = 0.0
        for part, target in zip(known, targets, strict=True):
            high = part.alpha * plus / (1 + part.a * plus)
            low = -part.alpha * minus / (1 - part.a * minus)
            total += (high / target.rho_plus - 1) ** 2 + (low / target.rho_minus - 1) ** 2
        return float(total)

    plus = float(fit.coefficients[0].omega_plus)
    minus = -float(fit.coefficients[0].omega_minus)
    assert abs(chi2(plus, minus) / fit.chi2 - 1) < 1e-8
    for factors in ((1.001, 1), (0.999, 1), (1, 1.001), (1, 0.999)):
        assert chi2(plus * factors[0], minus * factors[1]) > fit.chi2


@pytest.mark.slow  # fits to two targets, a program of their own
@pytest.mark.parametrize(("gap", "success"), [(0.01, True), (0.2, False)])
def test_uncertainties_decide_what_contradicts(gap, success):
    targets = [
        fx.Target(HOMOTHETIC, 0.3, -0.1, uncertainty=0.01),
        fx.Target(HOMOTHETIC, 0.3 + gap, -0.1, uncertainty=(0.01, 0.02)),
    ]
    fit = fx.fit_profile(targets, starts=2)
    assert fit.success == success
    assert abs(fit.chi2 / (2 * (gap / 2 / 0.01) ** 2) - 1) < 1e-6


def test_waves_that_are_nothing_have_no_sign():
    waves = np.array([0.1, -0.0, 0.0, -0.0])  # of sines, then of cosines
    cos, sin = map(np.asarray, _series(waves, np.array(2.0)))
    assert not cos.any()
    assert not np.signbit(cos).any()
    assert sin[0] > 0
    assert not np.signbit(sin).any()


@pytest.mark.slow
def test_one_harmonic_is_a_sine():
    fit = fx.fit_profile(fx.Target(HOMOTHETIC, 0.2, -0.2), harmonics=1, starts=2)
    assert fit.success
    np.testing.assert_allclose(np.hypot(fit.profile.cos, fit.profile.sin), 0.1 / np.pi)
    assert not fx.fit_profile(
        fx.Target(HOMOTHETIC, 0.3, -0.2), harmonics=1, starts=2
    ).success


def test_units_do_not_matter():
    """Forces a million times larger on the same surface: the same fit."""
    small = fx.fit_profile(fx.Target(fx.bristles.Homothetic(1e-6), 3e-7, -1e-7), starts=2)
    large = fx.fit_profile(fx.Target(fx.bristles.Homothetic(1e6), 3e5, -1e5), starts=2)
    np.testing.assert_allclose(small.profile.sin, large.profile.sin, rtol=1e-6, atol=1e-9)
    tiny = fx.fit_profile(fx.Target(HOMOTHETIC, 3e-6, -1e-6), starts=2)
    np.testing.assert_allclose(1e5 * tiny.profile.sin, large.profile.sin, rtol=1e-5)
    assert jnp.all(jnp.isfinite(tiny.profile.sin))


def test_a_closed_form_is_taken_and_told():
    """The same surface as by descent, to what the barrier leaves; proven to rounding."""
    target = fx.Target(HOMOTHETIC, 0.3, -0.2)
    fit = fx.fit_profile(target, **BOUNDED)
    assert fit.success
    assert fit.largest_error < 1e-13
    assert fit.bending_energy == pytest.approx(fit.bending_bound, rel=1e-12)
    assert [(start.steps, start.ran) for start in fit.starts] == [(1, True), (0, False)]
    # With bounds on heights, not felt, the same problem goes through the barrier.
    unfelt = {"largest_amplitude": 10.0, "smallest_radius": 1e-3}
    other = fx.fit_profile(target, **unfelt, **BOUNDED)
    assert min(start.steps for start in other.starts) > 10
    assert fit.bending_energy <= other.bending_energy <= fit.bending_energy * 1.001
    assert np.max(np.abs(fit.profile.sin - other.profile.sin)) < 1e-3


@pytest.mark.slow  # a program of its own
def test_one_proven_start_stands_for_all_and_no_other_does():
    """Where targets contradict each other every start has its own descent."""
    flattened = fx.fit_profile(fx.Target(HOMOTHETIC, 0.3, -0.1), starts=3)
    assert flattened.bending_energy <= flattened.bending_bound * (1 + 5e-3)
    assert len({start.bending_energy for start in flattened.starts}) == 1
    assert [start.number for start in flattened.starts] == [0, 1, 2]
    assert [start.ran for start in flattened.starts] == [True, False, False]
    assert [start.steps > 0 for start in flattened.starts] == [True, False, False]
    assert np.isfinite(flattened.history.loss[0, 0])
    assert np.all(np.isnan(flattened.history.loss[1:]))
    assert np.all(np.isnan(flattened.history.cos[1:]))
    torn = [fx.Target(HOMOTHETIC, 0.3, -0.1), fx.Target(HOMOTHETIC, 0.36, -0.1)]
    fit = fx.fit_profile(torn, starts=3)
    assert fit.status.name == "CONTRADICTORY"
    assert len({start.bending_energy for start in fit.starts}) == 3
    assert all(start.ran for start in fit.starts)
    energies = [start.bending_energy for start in fit.starts]
    assert max(energies) < min(energies) * 1.001


@pytest.mark.slow
def test_a_free_angle_is_followed_to_the_least_bending():
    """315 steps: the energy is 0.627 where 200 of them end."""
    part = fx.bristles.SlantedSpring(1.594244841476, 1.897988490612, 1.0, 1.044173817091)
    target = fx.Target(part, 0.0081320531849, -0.1367262558056)
    bounds = {"angle": (-1.031499433886, 1.0454)}
    fit = fx.fit_profile(target, free="angle", bounds=bounds, pulling=True)
    assert fit.success
    assert fit.status == ProfileStatus.MET
    assert fit.bending_energy == pytest.approx(0.427, rel=2e-3)


@pytest.mark.slow
def test_a_free_rod_may_end_where_it_hardly_follows():
    """The least bending is at the open end of the slopes allowed: the fit keeps off it."""
    rod = fx.bristles.AngularSpring(1.0, 1.414, 1.0, 0.3)
    target = fx.Target(rod, 0.12, -0.05)
    fit = fx.fit_profile(target, starts=1, free="angle", bounds={"angle": (0.1, 1.5)})
    assert fit.status is ProfileStatus.MET
    assert fit.largest_error < 1e-9
    upper = float(geometry(fit.bristles[0]).upper)
    assert 1e-4 < 1 - float(fit.coefficients[0].omega_plus) / upper < 2e-3
