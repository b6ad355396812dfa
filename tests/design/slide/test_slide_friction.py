"""Steady slides: the engine's own forces, SciPy's, their limit and their derivatives."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from reference import series
from scipy.integrate import solve_ivp

import frictionjax as fx
from frictionjax.design.slide.slide_friction import _joined, where_found
from frictionjax.design.slide.slide_sides import Sides
from frictionjax.wiggly.equation.status import Status

COS, SIN = [0.004, 0.002], [0.015, -0.003]
WAVES = fx.profiles.Fourier(COS, SIN)
SINE = fx.profiles.Sine(0.1)
K, REST, HEIGHT, ANGLE = 1.0, 2.4, 1.0, 1.0
SLANTED = fx.bristles.SlantedSpring(K, REST, HEIGHT, ANGLE)
VERTICAL = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
ANGULAR = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)


def plain_slide(eps, gamma, rate, stiffness, sign, slips):
    """Mean and peak force of one slip after some, by SciPy's Radau in time, by hand."""
    w, lean, cosine = series(COS, SIN), np.tan(ANGLE), np.cos(ANGLE)

    def state_and_force(y):
        height, slope = w(y)
        eta = eps * height
        press = K * (REST - (HEIGHT - eta) / cosine) / cosine
        stretch = 1 - lean * slope
        return eps * y - eta * lean, press * slope / stretch, stretch

    def field(t, state):
        z, wiggle, stretch = state_and_force(state[0])
        force = sign * rate * t - stiffness * z
        return [(force - wiggle) / (eps ** (gamma + 1) * stretch), force]

    period = eps * stiffness / rate
    start, end = 0.0, (0.15 + slips * eps) * stiffness / rate
    options = {"method": "Radau", "rtol": 1e-9, "atol": [1e-10, 1e-14]}
    begin = [0.0, 0.0]
    with np.errstate(over="ignore"):  # in SciPy's own differences by the mean, which are 0
        step = period / 30
        settled = solve_ivp(field, (start, end), begin, max_step=step, **options)
        begin, step = [settled.y[0, -1], 0.0], period / 500
        slip = solve_ivp(field, (end, end + period), begin, max_step=step, **options)
    assert slip.y[0, -1] - slip.y[0, 0] == pytest.approx(sign, abs=1e-6)
    forces = [
        sign * rate * t - stiffness * state_and_force(y)[0]
        for t, y in zip(slip.t, slip.y[0], strict=True)
    ]
    peak = max(forces) if sign > 0 else min(forces)
    return slip.y[1, -1] / period, peak


@pytest.mark.parametrize("by", [np, jnp])
@pytest.mark.parametrize("status", list(Status))
def test_forces_of_a_slide_that_is_not_found_are_no_numbers(status, by):
    """A slide of a traced bristle that there is not had a mean of 0 N and a status."""
    code, one = by.asarray([int(Status.OK), int(status)]), by.asarray([1.0, -2.0])
    slide = _joined(by.asarray(0.1), where_found(Sides(one, one, code, one), by))
    lost = status in (Status.MAX_STEPS, Status.NOT_FINITE, Status.SOLVER_FAILED)
    assert slide.mean_plus == slide.peak_plus == 1.0
    assert [np.isnan(f) for f in (slide.mean_minus, slide.peak_minus)] == [lost, lost]
    assert np.isnan(slide.ratio) == lost


@pytest.mark.parametrize(
    ("eps", "gamma", "rate", "slips"),  # until SciPy's slide is steady
    [pytest.param(0.05, 1.0, 1.0, 24, marks=pytest.mark.slow), (0.1, 1.5, 0.3, 6)],
)
def test_forces_are_those_of_an_integration_in_time(eps, gamma, rate, slips):
    support = fx.supports.Spring(0.7)
    found = fx.steady_slide(WAVES, SLANTED, eps, gamma, rate, support)
    assert found.ok
    assert found.status == Status.OK
    right = plain_slide(eps, gamma, rate, 0.7, 1, slips)
    left = plain_slide(eps, gamma, rate, 0.7, -1, slips)
    means, peaks = (found.mean_plus, found.mean_minus), (found.peak_plus, found.peak_minus)
    np.testing.assert_allclose(means, (right[0], left[0]), rtol=1e-6)
    # SciPy's is the largest of some 500 samples.
    np.testing.assert_allclose(peaks, (right[1], left[1]), rtol=1e-5)
    assert found.ratio == -found.mean_plus / found.mean_minus


@pytest.mark.slow
def test_mean_force_is_what_the_engine_dissipates_in_a_slip():
    eps, rate = 1e-3, -1.0
    scene = fx.Scene(
        WAVES, ANGULAR, fx.supports.Spring(1.0), fx.loads.Ramp(rate), duration=0.3
    )
    times = 0.2 + eps * np.arange(0, 21, 10)
    run = fx.solve(scene, eps, 1.0, ts=times, accuracy=1e-6)
    assert run.ok
    slips = np.diff(run.z) / eps
    np.testing.assert_allclose(slips, -10, rtol=1e-7)
    found = fx.steady_slide(WAVES, ANGULAR, eps)
    np.testing.assert_allclose(
        -np.diff(run.dissipation) / (10 * eps), found.mean_minus, rtol=1e-5
    )


def test_a_rod_that_is_hardly_longer_than_high_slides_as_the_engine_says():
    """Its series has 12 degrees, others 8 at most."""
    rod = fx.bristles.AngularSpring(1.0, 1.05, 1.0, 0.1)
    found = fx.steady_slide(SINE, rod, [0.01, 0.2])
    assert np.all(found.ok)
    for rate, mean in ((1.0, found.mean_plus[1]), (-1.0, found.mean_minus[1])):
        load = fx.loads.Ramp(rate)
        scene = fx.Scene(SINE, rod, fx.supports.Spring(1.0), load, duration=4.2)
        run = fx.solve(scene, 0.2, 1.0, ts=[4.0, 4.2], accuracy=1e-6)
        spent = float(np.diff(run.dissipation)[0])
        assert spent / (0.2 * rate) == pytest.approx(float(mean), rel=1e-5)


def test_a_design_for_a_ratio_shows_it_at_small_eps():
    found = fx.fit_angle(WAVES, SLANTED, ratio=1.3)
    assert found.success
    check = fx.check_design(WAVES, found.bristle)
    assert np.all(check.slide.ok)
    assert abs(check.slide.ratio[2] / 1.3 - 1) < 0.01
    assert abs(check.gap_ratio[2]) < abs(check.gap_ratio[0])
    assert float(check.ratio) == pytest.approx(1.3, rel=1e-10)
    lines = repr(check).splitlines()
    assert len(lines) == 6
    assert lines[0].startswith("Steady slide, gamma = 1, rate = 1 N/s")
    shown = [float(word) for word in lines[4].split()[:2]]
    np.testing.assert_allclose(shown, (1e-4, check.slide.mean_plus[2]), rtol=1e-5)
    assert lines[4].split()[-1] == "ok"


def test_viscosity_that_floats_hardly_resolve():
    law = fx.friction(WAVES, SLANTED)
    found = fx.steady_slide(WAVES, SLANTED, np.array([1e-5, 1e-6, 1e-7]), gamma=2.0)
    half_drop = 0.5 * found.eps  # the force falls by k_h eps in a slip
    assert np.all(np.isfinite(found.mean_plus))
    expected = law.rho_plus - half_drop
    assert found.ok.all()
    gaps = np.abs(found.mean_plus - expected)
    assert np.all(gaps < 0.1 * found.eps + 1e-5 * law.rho_plus)


def test_slow_forgetting_at_small_gamma():
    # A slip keeps 0.99 of a disturbance: waiting would take thousands of them.
    one = fx.steady_slide(WAVES, SLANTED, 1e-4, gamma=0.3)
    assert one.ok
    # A thousand times softer, errors of the steps add up: told, not shown as a force.
    law = np.hypot(0.1, 1e-4**0.3)
    for stiffness, known in ((1.0, True), (1e-3, False)):
        spring = fx.supports.Spring(stiffness)
        slide = fx.steady_slide(SINE, VERTICAL, 1e-4, 0.3, rate=stiffness, support=spring)
        assert bool(slide.code_plus == int(Status.OK)) is known
        assert bool(abs(slide.mean_plus / law - 1) < 3e-4) is known
        assert known or slide.code_plus == int(Status.OPEN_BRACKET)
    # Far above the fold the tip does not see the wells: D is nearly steady.
    fast = fx.steady_slide(WAVES, SLANTED, 1e-3, gamma=0.3, rate=100.0)
    assert fast.ok
    steady = 100.0 * 1e-3**0.3
    # <1/D> = 1/D0 and D = f - U with f steady: mean f = D0 + var(U)/D0 + ...
    excess = float(fast.mean_plus) / steady - 1
    wiggle = fx.potential(WAVES, SLANTED).force(1e-3 * np.arange(512) / 512, 1e-3)
    assert excess == pytest.approx(float(np.mean(wiggle**2)) / steady**2, rel=0.02)


def forces(p):
    """All four forces from the numbers of everything that enters."""
    surface = fx.profiles.Fourier(p[0:2], p[2:4])
    part = fx.bristles.SlantedSpring(*p[4:8])
    found = fx.steady_slide(surface, part, p[8], p[9], p[10], fx.supports.Spring(p[11]))
    names = ("mean_plus", "mean_minus", "peak_plus", "peak_minus")
    return jnp.stack([getattr(found, name) for name in names])


@pytest.mark.slow
@pytest.mark.parametrize(("eps", "gamma"), [(1e-3, 1.0), (1e-2, 0.5)])
def test_derivatives_are_central_differences(eps, gamma):
    numbers = [*COS, *SIN, 1.3, REST, HEIGHT, ANGLE, eps, gamma, 0.8, 1.2]
    p = jnp.asarray(numbers)
    values, pull = jax.vjp(forces, p)
    found = np.stack([pull(side)[0] for side in jnp.eye(4)])
    values = np.abs(np.asarray(values))
    for i, number in enumerate(numbers):
        # Steps are chosen anew for each value: 1e-9 of noise asks for a wide stencil.
        step = 5e-3 * abs(number)
        ends = [forces(p.at[i].set(number + s * step)) for s in (-2, -1, 1, 2)]
        central = (8 * (ends[2] - ends[1]) - (ends[3] - ends[0])) / (12 * step)
        size = np.maximum(np.abs(np.asarray(central)), values / abs(number))
        gap = np.abs(np.asarray(found[:, i] - central)) / size
        assert gap.max() < 1e-5, f"number {i}"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"eps": 0.0}, "eps = 0: needs eps > 0"),
        ({"eps": [1e-3, float("nan")]}, "eps = .*needs eps > 0"),
        ({"eps": np.full((2, 2), 1e-3)}, r"eps = 'shape \(2, 2\)': needs"),
        ({"gamma": -1.0}, "gamma = -1: needs gamma > 0"),
        ({"rate": 0.0}, "rate = 0: needs rate > 0"),
        ({"support": 1.0}, "support = 'float': needs a frictionjax.supports.Spring"),
        ({"bristle": fx.bristles.SlantedSpring(1.0, 9.0, 1.0, 1.48)}, "bristle.angle"),
        ({"bristle": ANGULAR, "eps": 50.0}, "eps = 50: needs eps <"),
    ],
)
def test_wrong_arguments_are_named(change, words):
    numbers = {"profile": SINE, "bristle": SLANTED, "eps": 1e-3} | change
    with pytest.raises(ValueError, match=words):
        fx.steady_slide(**numbers)


@pytest.mark.slow
def test_a_viscosity_that_floats_do_not_resolve_is_told():
    """The left force at eps = 1e-4 is 0.55% off `fx.solve`, at 1e-5 36% off the limit."""
    steep = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, -1.470730857)
    eps = np.array([1e-2, 1e-3, 1e-4, 1e-5])
    found = fx.steady_slide(fx.profiles.Sine(0.1), steep, eps)
    assert np.array_equal(found.ok, [True, False, False, False])
    assert np.all(found.code_minus[1:] == int(fx.Status.STEP_TOO_SMALL))
    usual = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
    replaced = fx.steady_slide(
        fx.profiles.Sine(0.1), usual, np.array([1e-5, 1e-7]), gamma=2
    )
    assert np.all(replaced.ok)
    limit = float(fx.friction(fx.profiles.Sine(0.1), usual).rho_plus)
    assert float(replaced.mean_plus[1]) == pytest.approx(limit, rel=1e-6)


PAIR = [0.0, 0.15]


def array_of(offsets, weights=None):
    return (fx.effects.RigidArray(jnp.asarray(offsets), weights),)


@pytest.mark.slow
def test_slides_of_rigid_arrays_are_those_of_friction_curve():
    effects = array_of(PAIR, [1.0, 2.0])
    found = fx.steady_slide(WAVES, SLANTED, 0.05, 1.0, 0.3, effects=effects)
    parts = fx.supports.Spring(1.0), fx.loads.Ramp(1.0), 1.0
    scene = fx.Scene(WAVES, SLANTED, *parts, effects=effects)
    curve = fx.friction_curve(scene, [0.3, -0.3], 0.05)
    both = [float(found.mean_plus), float(found.mean_minus)]
    assert both == pytest.approx(curve.mean_force.values, rel=1e-7)
    one = fx.steady_slide(WAVES, SLANTED, 0.05, 1.0, 0.3)
    assert 1.5 * float(one.mean_plus) < both[0] < 3 * float(one.mean_plus)


@pytest.mark.slow
def test_arrays_have_derivatives_in_their_places_and_parts():
    """Of the slide and of the coefficients, against differences."""

    def slide(numbers):
        slope, place = numbers
        profile = fx.profiles.Sine(slope)
        effects = array_of(jnp.stack([0.0 * place, place]))
        return fx.steady_slide(profile, SLANTED, 0.05, effects=effects).mean_plus

    def rho(numbers):
        slope, place = numbers
        parts = fx.supports.Spring(1.0), fx.loads.Ramp(1.0), 1.0
        effects = array_of(jnp.stack([0.0 * place, place]))
        profile = fx.profiles.Sine(slope)
        return fx.friction(fx.Scene(profile, SLANTED, *parts, effects=effects)).rho_plus

    at, step = np.array([0.1, 0.15]), 1e-5
    for quantity, close in ((slide, 1e-5), (rho, 1e-7)):
        exact = np.asarray(jax.grad(quantity)(jnp.asarray(at)))
        for i, moved in enumerate(step * np.eye(2)):
            ends = [float(quantity(jnp.asarray(at + s * moved))) for s in (1, -1)]
            known = (ends[0] - ends[1]) / (2 * step)
            assert exact[i] == pytest.approx(known, rel=close), (quantity, i)


@pytest.mark.parametrize(
    ("effects", "message"),
    [
        (
            (fx.effects.CompliantArray(np.linspace(0, 1, 20_001)),),
            r"CompliantArray\.offsets: number of bristles = 20001: needs at most 20000",
        ),
        ((fx.effects.Noise(1e-3),), "does not do Noise: needs friction_curve"),
        (array_of([0.0, 0.5]), "effects: rho_plus = 0: needs tips whose forces"),
        (fx.effects.LeadingOrder(), r"effects = .*needs effects of frictionjax"),
    ],
)
def test_effects_that_slides_do_not_do_are_refused(effects, message):
    with pytest.raises(ValueError, match=message):
        fx.steady_slide(SINE, fx.bristles.Homothetic(1.0), 0.05, effects=effects)
