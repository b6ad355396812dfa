"""`RigidArray`: potentials add."""

import math

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy import integrate, optimize

import frictionjax as fx
from frictionjax.effects import Engine
from frictionjax.model import scene_for, tabulated_scene

SINE = fx.profiles.Sine(0.1)
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
VERTICAL = fx.bristles.VerticalSpring(1.0, 1.5, 1.0)
SUPPORT, LOAD = fx.supports.Spring(1.0), fx.loads.Sine(1.0488, 3.0)


def scene_of(*effects, profile=SINE, bristle=SLANTED):
    return fx.Scene(profile, bristle, SUPPORT, LOAD, 3.0, effects=effects)


def rho_of(offsets, weights=None, **parts):
    found = fx.friction(scene_of(fx.effects.RigidArray(offsets, weights), **parts))
    return float(found.rho_plus), float(found.rho_minus)


def test_equal_phases_add_up():
    one = fx.friction(SINE, SLANTED)
    for count in (1, 2, 5):
        plus, minus = rho_of([0.3] * count)
        assert plus == pytest.approx(count * float(one.rho_plus), rel=1e-12)
        assert minus == pytest.approx(count * float(one.rho_minus), rel=1e-12)


LEAN = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
RATCHET = fx.profiles.Polyline([0.0, 0.8], [0.0, 0.05], radius=0.005)
MANY = np.arange(1, 41)
ROUGH = {
    "sine": (SINE, SLANTED),
    "corners": (RATCHET, LEAN),
    "heights": (
        fx.profiles.Spline(0.02 * np.sin(0.3 + 2 * np.pi * np.arange(64) / 64) ** 3),
        SLANTED,
    ),
    "harmonics": (fx.profiles.Fourier(0.01 / MANY**2, 0.02 / MANY**3), SLANTED),
    "a function": (
        fx.profiles.Custom(lambda y: 0.02 * jnp.exp(jnp.sin(2 * jnp.pi * y))),
        SLANTED,
    ),
}


@pytest.mark.parametrize("name", ROUGH)
def test_one_tip_is_the_scene_itself(name):
    profile, bristle = ROUGH[name]
    plain = fx.friction(profile, bristle)
    expected = float(plain.rho_plus), float(plain.rho_minus)
    for offset in (0.0, 0.3):
        found = rho_of([offset], profile=profile, bristle=bristle)
        assert found == pytest.approx(expected, rel=1e-9)


@pytest.mark.slow  # a program of its own: 12 s
def test_traced_tips_over_corners_have_the_friction_of_known_ones():
    @jax.jit
    def traced(offsets):
        array = fx.effects.RigidArray(offsets)
        found = fx.friction(scene_of(array, profile=RATCHET, bristle=LEAN))
        return found.rho_plus, found.rho_minus

    offsets = [0.1, 0.3, 0.75]
    known = rho_of(offsets, profile=RATCHET, bristle=LEAN)
    assert known == pytest.approx([float(v) for v in traced(np.array(offsets))], rel=1e-9)


@pytest.mark.slow  # the inverse of a surface of its own: 6 s
def test_forces_of_tips_over_corners_are_those_of_each():
    """At an eps that is not 0, between places that tables were made of."""
    offsets, eps, z = np.array([0.0, 0.13, 0.6]), 0.05, np.linspace(0, 0.05, 977)
    scene = scene_of(fx.effects.RigidArray(offsets), profile=RATCHET, bristle=LEAN)
    table = tabulated_scene(scene_for(Engine.PATH, scene), eps).potential
    alone = fx.potential(RATCHET, LEAN)
    expected = sum(np.asarray(alone.force(z + eps * o, eps)) for o in offsets)
    found = table.force(z, eps)
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.max(np.abs(expected)))


@pytest.mark.slow  # loops of their own: 30 s
@pytest.mark.parametrize("name", ["corners", "harmonics"])
def test_one_tip_moves_as_the_scene_itself(name):
    profile, bristle = ROUGH[name]
    scene = scene_of(profile=profile, bristle=bristle)
    array = scene.replace(effects=(fx.effects.RigidArray([0.0]),))
    ts, eps = np.linspace(0, 3, 7), 0.02
    plain, one = (fx.solve(s, eps, ts=ts, accuracy=1e-4) for s in (scene, array))
    assert one.ok
    np.testing.assert_allclose(one.z, plain.z, atol=2e-4 * eps)
    limits = [fx.solve_limit(s, ts) for s in (scene, array)]
    np.testing.assert_allclose(limits[1].z, limits[0].z, atol=1e-9)
    slides = [
        fx.steady_slide(profile, bristle, eps, effects=e) for e in ((), array.effects)
    ]
    assert slides[1].mean_plus == pytest.approx(float(slides[0].mean_plus), rel=1e-6)
    assert slides[1].mean_minus == pytest.approx(float(slides[0].mean_minus), rel=1e-6)


def test_more_corners_than_there_is_room_for_are_refused():
    offsets = np.random.default_rng(3).uniform(size=9000)
    with pytest.raises(ValueError, match=r"effects\.RigidArray: .* needs fewer tips"):
        rho_of(offsets, profile=RATCHET, bristle=LEAN)


def test_phases_spread_evenly_over_a_sine_leave_nothing():
    bristle = fx.bristles.Homothetic(1.0)
    assert rho_of(np.arange(3) / 3, bristle=bristle) == (0.0, 0.0)
    spread = (fx.effects.RigidArray(np.arange(3) / 3),)
    parts = SINE, bristle, fx.supports.Spring(2.0), fx.loads.Ramp(1.0)
    one = fx.Scene(*parts, 1.0, effects=spread)
    limit = fx.solve_limit(one, [0.5, 1.0])  # without friction the load is followed
    np.testing.assert_allclose(limit.z, [0.25, 0.5], rtol=1e-12)
    np.testing.assert_array_equal(limit.dissipation, 0.0)
    with pytest.raises(ValueError, match=r"RigidArray: rho_plus = 0: needs phases that"):
        fx.solve(one, 0.05)


def test_phases_spread_evenly_leave_the_harmonics_that_they_divide():
    profile = fx.profiles.Fourier(cos=[0.0, 0.0, 0.0], sin=[0.02, 0.01, 0.003])
    bristle = fx.bristles.Homothetic(1.0)
    plus, minus = rho_of(np.arange(3) / 3, profile=profile, bristle=bristle)
    assert plus == pytest.approx(3 * 0.003 * 6 * np.pi, rel=1e-12)
    assert minus == pytest.approx(-plus, rel=1e-12)


@pytest.mark.slow  # a program of its own
def test_random_phases_add_up_like_a_random_walk():
    count, turns = 400, np.random.default_rng(7)
    bristle = fx.bristles.Homothetic(1.0)
    one = float(fx.friction(SINE, bristle).rho_plus)

    @jax.jit
    def rho_plus(offsets):
        scene = scene_of(fx.effects.RigidArray(offsets), bristle=bristle)
        return fx.friction(scene).rho_plus

    found = [float(rho_plus(turns.uniform(size=count))) for _ in range(200)]
    mean = np.mean(found) / (one * np.sqrt(count))
    # sqrt(pi)/2, and its standard error over 200 arrays is 0.033.
    assert mean == pytest.approx(0.8862269, abs=3 * 0.4633 / np.sqrt(200))


def test_weights_are_how_often_a_tip_stands_there():
    repeated = rho_of([0.0, 0.1, 0.1, 0.1])
    assert rho_of([0.0, 0.1], [1.0, 3.0]) == pytest.approx(repeated, rel=1e-12)


@pytest.mark.slow
def test_a_hundred_thousand_tips_are_no_more_work():
    phases = np.random.default_rng(0).uniform(0, 0.5, 100_000)
    plus, _ = rho_of(phases)
    scene = scene_of(fx.effects.RigidArray(phases))
    wide = scene.replace(load=fx.loads.Sine(3 * plus, 3.0))
    solution = fx.solve(wide, 1e-2, ts=[1.0, 3.0])
    assert solution.ok


OFFSETS, WEIGHTS = [0.0, 0.1, 0.25], [1.0, 2.0, 1.0]


def pull_of_all(z, eps, angle):
    """Of the tips on one root, each where its spring meets the surface."""
    lean, cosine, total = math.tan(angle), math.cos(angle), 0.0
    for offset, weight in zip(OFFSETS, WEIGHTS, strict=True):
        phase = z / eps + offset
        place = optimize.brentq(
            lambda y, phase=phase: y - lean * height_and_slope(y)[0] - phase,
            phase - 1,
            phase + 1,
            xtol=1e-14,
        )
        height, slope = height_and_slope(place)
        press = (2.4 - (1.0 - eps * height) / cosine) / cosine
        total += weight * press * slope / (1 - lean * slope)
    return total


def height_and_slope(y):
    turn = 2 * math.pi * y
    return 0.1 / (2 * math.pi) * math.sin(turn), 0.1 * math.cos(turn)


# Leaning tips have the harmonics of another loop of lanes: 14 s to compile.
@pytest.mark.parametrize("angle", [0.0, pytest.param(0.5, marks=pytest.mark.slow)])
def test_lanes_meet_the_sum_itself(angle):
    """The exact sum of the tips' potentials, slip by slip, by hand and SciPy."""
    bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, angle)
    array = fx.effects.RigidArray(OFFSETS, WEIGHTS)
    scene = scene_of(array, bristle=bristle).replace(duration=1.2)
    ts, eps = np.linspace(0, 1.2, 7), 0.05

    def rates(t, z):
        load = 1.0488 * math.sin(2 * math.pi * t / 3)
        return [(load - z[0] - pull_of_all(z[0], eps, angle)) / eps]

    exact = integrate.solve_ivp(
        rates, (0, 1.2), [0.0], "LSODA", t_eval=ts, rtol=1e-8, atol=1e-9 * eps
    )
    lanes = fx.solve(scene, eps, ts=ts)
    assert lanes.ok
    np.testing.assert_allclose(lanes.z, exact.y[0], atol=2e-4 * eps)


@pytest.mark.slow
def test_solvers_by_name_meet_the_sum_itself():
    scene = scene_of(fx.effects.RigidArray(OFFSETS, WEIGHTS)).replace(duration=1.2)
    ts, eps = np.linspace(0, 1.2, 7), 0.05
    exact = fx.solve(scene, eps, ts=ts, method="Kvaerno5")
    assert exact.ok
    lanes = fx.solve(scene, eps, ts=ts)
    np.testing.assert_allclose(lanes.z, exact.z, atol=2e-4 * eps)


LEANING = fx.bristles.SlantedSpring(1, 2.4, 1, 0.5)


# Leaning tips have harmonics of another loop of lanes.
@pytest.mark.parametrize(
    "bristle", [VERTICAL, pytest.param(LEANING, marks=pytest.mark.slow)]
)
def test_certificates_know_the_sum(bristle):
    scene = scene_of(fx.effects.RigidArray(OFFSETS, WEIGHTS), bristle=bristle)
    scene, ts, eps = scene.replace(duration=1.2), np.linspace(0, 1.2, 6001), 0.05
    z = np.asarray(fx.solve(scene, eps, ts=ts).z)
    assert fx.certify(scene, eps, 1.0, ts, z).ok
    assert not fx.certify(scene, eps, 1.0, ts, z + 0.1 * eps).ok
    assert not fx.certify(scene.replace(effects=()), eps, 1.0, ts, z).ok


def test_every_eps_of_a_sweep_has_its_own_sum():
    scene = scene_of(fx.effects.RigidArray([0.0, 0.1]), bristle=VERTICAL)
    ts = np.linspace(0, 3, 7)
    data = fx.sweep(scene, [2e-2, 1e-2], [0.75, 1.0], ts)
    assert "RigidArray" in data.attrs["scene"]
    for eps in (2e-2, 1e-2):
        alone = fx.solve(scene, eps, 0.75, ts=ts)
        found = data.z.sel(eps=eps, gamma=0.75)
        np.testing.assert_allclose(found, alone.z, rtol=1e-14)


@pytest.mark.parametrize(
    ("offsets", "weights", "words"),
    [
        ([], None, r"effects\.RigidArray\.offsets = .*shape \(N,\)"),
        ([[0.1]], None, r"effects\.RigidArray\.offsets = .*shape \(N,\)"),
        ([0.1, np.nan], None, r"effects\.RigidArray\.offsets = .*finite"),
        ([0.1, 0.2], [1.0], r"effects\.RigidArray\.weights = .*2 weights"),
        ([0.1, 0.2], [1.0, -1.0], r"effects\.RigidArray\.weights = .*>= 0"),
        ([0.1, 0.2], [0.0, 0.0], r"effects\.RigidArray\.weights = .*> 0"),
    ],
)
def test_what_is_no_array_is_refused(offsets, weights, words):
    with pytest.raises(ValueError, match=words):
        fx.effects.RigidArray(offsets, weights)


def test_leading_orders_of_all_tips():
    both = fx.effects.RigidArray([0.0, 0.1]), fx.effects.LeadingOrder()
    scene = scene_of(*both, bristle=VERTICAL)
    other = scene_of(*both[::-1], bristle=VERTICAL)
    plain = scene_of(both[0], bristle=fx.bristles.Homothetic(0.5))
    solutions = [fx.solve(s, 1e-2, ts=[1.0, 2.0]).z for s in (scene, other, plain)]
    np.testing.assert_allclose(solutions[0], solutions[1], atol=1e-8)
    np.testing.assert_allclose(solutions[0], solutions[2], atol=1e-6)
    whole = scene_of(both[0], bristle=VERTICAL)
    assert not jnp.array_equal(solutions[0], fx.solve(whole, 1e-2, ts=[1.0, 2.0]).z)
