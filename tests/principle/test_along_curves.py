"""D and D_eps of curves: against quadrature, what solutions dissipate, and the balance."""

import equinox as eqx
import jax
import numpy as np
import pytest
from samples import pair
from scipy.integrate import simpson

import frictionjax as fx

D, D_eps, K = fx.principle.D, fx.principle.D_eps, fx.principle.K
SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.05, 3.0),
    3.0,
)
TS = np.linspace(0.0, 3.0, 3001)
OTHER = SCENE.replace(
    profile=fx.profiles.Fourier([0.0, 0.004], [0.015, 0.0]),
    bristle=fx.bristles.AngularSpring(1.0, 1.414, 1.0, 0.3),
    support=fx.supports.Convex(lambda z: 0.5 * z**2 + 0.1 * z**4),
)


def balance(scene, ts, z):
    """`E(t2) - E(t1) + int l' z = Phi(t2) - Phi(t1) - int l dz`, finely sampled."""
    load, stored = loads_and_ends(scene, ts, z[[0, -1]])
    load = np.asarray(load)
    work = np.sum(np.diff(z) * (load[1:] + load[:-1]) / 2)
    return float(np.diff(stored)[0] - work)


@eqx.filter_jit
def loads_and_ends(scene, ts, ends):
    return jax.vmap(scene.load)(ts), jax.vmap(scene.support.energy)(ends)


BOTH = [
    pytest.param(SCENE, id="slanted"),
    pytest.param(OTHER, id="angular", marks=pytest.mark.slow),
]


@pytest.mark.parametrize("scene", BOTH)
def test_of_a_solution_of_the_limit_D_is_what_friction_takes(scene):
    found = fx.solve_limit(scene, TS)
    dissipated = float(found.dissipation[-1])
    assert D(scene, TS, found.z) == pytest.approx(dissipated, rel=1e-5)
    z = np.asarray(found.z)
    assert abs(balance(scene, TS, z) + D(scene, TS, z)) < 1e-5 * dissipated
    coarse = fx.solve_limit(scene, TS[::10])  # second order: 100 times as much
    off = abs(D(scene, TS[::10], coarse.z) / dissipated - 1)
    assert off < 1e-3


def test_inside_the_strip_D_is_more_than_the_work():
    """A curve that is dragged through the middle of the strip: K by quadrature."""
    z = np.asarray(jax.vmap(SCENE.load)(TS)) - 0.02
    xi = np.full(TS.size, 0.02)
    expected = float(K(SCENE, 0.02)) * np.sum(np.abs(np.diff(z)))
    assert D(SCENE, TS, z) == pytest.approx(expected, rel=1e-12)
    rest = balance(SCENE, TS, z) + D(SCENE, TS, z)
    assert rest == pytest.approx(expected - np.sum(xi[1:] * np.diff(z)), abs=1e-9)
    assert rest > 0.5 * expected


def test_outside_the_strip_D_is_infinite():
    z = np.array(fx.solve_limit(SCENE, TS).z)
    assert np.isfinite(D(SCENE, TS, z))
    z[1500] += 1e-3 * (1 + abs(z[1500]))
    assert D(SCENE, TS, z) == np.inf
    assert D(SCENE, [0.0, 3.0], [0.5, 0.5]) == np.inf
    assert D(SCENE, [0.0, 3.0], [0.01, 0.01]) == 0.0


@pytest.mark.parametrize("load", [1e4, 1e6])
def test_large_loads_leave_rounding_in_forces(load):
    far = SCENE.replace(
        load=fx.loads.Ramp(load, load),
        support=fx.supports.Spring(load),
        z0=1.0 - 0.1 / load,
    )
    found = fx.solve_limit(far, TS)
    assert D(far, TS, found.z) == pytest.approx(float(found.dissipation[-1]), rel=1e-4)


FINE = 20001  # of all quadratures, which then share programs


def smooth(ts):
    return 0.3 * np.sin(ts) + 0.05 * ts


@eqx.filter_jit  # step by step nine programs for each number of times
def costs_at(scene, eps, gamma, ts, z, speed):
    rigid = jax.vmap(scene.load)(ts) - scene.support.force(z)
    force = rigid - scene.potential.force(z, eps)
    return fx.principle.M_eps(speed, force, eps, gamma)


def by_quadrature(scene, eps, gamma, ts, z, speed):
    eps, gamma = np.asarray(eps), np.asarray(gamma)
    cost = np.asarray(costs_at(scene, eps, gamma, ts, z, speed))
    return float(simpson(cost, x=ts))


@pytest.mark.parametrize("scene", [SCENE, OTHER], ids=["slanted", "angular"])
@pytest.mark.parametrize("gamma", [0.5, 1.5])
def test_D_eps_of_any_curve_against_quadrature(scene, gamma):
    """Of a curve that solves nothing: the integral as it is written."""
    eps, ts = 0.05, np.linspace(0.0, 2.0, FINE)
    z, speed = smooth(ts), 0.3 * np.cos(ts) + 0.05
    expected = by_quadrature(scene, eps, gamma, ts, z, speed)
    assert D_eps(scene, eps, gamma, ts, z) == pytest.approx(expected, rel=1e-6)
    few = ts[::50]
    assert D_eps(scene, eps, gamma, few, smooth(few)) == pytest.approx(expected, rel=1e-4)


def test_two_samples_are_a_straight_line():
    """Through 30 wells, with as many places as it takes."""
    eps, ts = 0.02, np.linspace(0.0, 2.0, FINE)
    expected = by_quadrature(SCENE, eps, 1.0, ts, 0.3 * ts, np.full(ts.size, 0.3))
    found = D_eps(SCENE, eps, 1.0, [0.0, 2.0], [0.0, 0.6])
    assert found == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("gamma", [pytest.param(0.7, marks=pytest.mark.slow), 1.0])
def test_of_a_solution_D_eps_is_what_viscosity_takes(gamma):
    eps, ts = 0.03, np.linspace(0.0, 3.0, 6001)
    found = fx.solve(SCENE, eps, gamma, ts)
    taken = float(found.dissipation[-1])
    assert D_eps(SCENE, eps, gamma, ts, found.z) == pytest.approx(taken, rel=3e-4)
    # Another curve costs more than its balance gives.
    z = np.asarray(found.z) + 0.1 * eps
    rest = D_eps(SCENE, eps, gamma, ts, z) + balance_eps(SCENE, eps, ts, z)
    assert rest > 0.1 * eps
    z = np.asarray(found.z)
    assert abs(D_eps(SCENE, eps, gamma, ts, z) + balance_eps(SCENE, eps, ts, z)) < 1e-4


def balance_eps(scene, eps, ts, z):
    wiggles = np.diff(scene.potential.energy(z[[0, -1]], eps))[0]
    return balance(scene, ts, z) + float(wiggles)


def test_the_limit_dissipates_no_more_than_what_comes_near():
    """`D(z) <= liminf D_eps(z_eps)`: solutions come from above, and attain it."""
    limit = float(fx.solve_limit(SCENE, TS).dissipation[-1])
    found = []
    for eps, count in ((0.1, 2001), (0.03, 6001), (0.015, 8001)):
        ts = np.linspace(0.0, 3.0, count)
        found.append(D_eps(SCENE, eps, 1.0, ts, fx.solve(SCENE, eps, ts=ts).z))
    assert np.all(np.diff(found) < 0)
    assert limit < found[-1] < 1.05 * limit


def test_loads_that_change_while_nothing_moves_are_seen():
    """At rest f = l - Phi' - V' goes up and down with the load alone."""
    still = SCENE.replace(load=fx.loads.Sine(0.05, 0.5))
    fine = np.linspace(0, 3, FINE)
    held = np.full(fine.size, -0.0125)
    expected = by_quadrature(still, 0.05, 1.0, fine, held, 0 * fine)
    for count in (2, 7, 13, 301):
        ts = np.linspace(0, 3, count)
        found = D_eps(still, 0.05, 1.0, ts, np.full(count, -0.0125))
        assert found == pytest.approx(expected, rel=1e-6)


@pytest.mark.slow  # tables of 64 harmonics
def test_surfaces_of_many_harmonics_are_seen():
    n = np.arange(1, 61)
    sharp = fx.profiles.Fourier(0 * n, 0.02 * np.exp(-((n / 40.0) ** 2)) / n)
    scene = SCENE.replace(profile=sharp, bristle=fx.bristles.Homothetic(1.0))
    fine = np.linspace(0.0, 2.0, 400001)
    speed = np.full(fine.size, 0.3)
    expected = by_quadrature(scene, 0.05, 1.0, fine, 0.3 * fine, speed)
    for count in (2, 11, 101):
        ts = np.linspace(0.0, 2.0, count)
        assert D_eps(scene, 0.05, 1.0, ts, 0.3 * ts) == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("amplitude", [1e5, 1e7])
def test_large_loads_near_their_zeros_carry_their_rounding(amplitude):
    large = SCENE.replace(load=fx.loads.Sine(amplitude, 3.0))
    ts = np.linspace(0, 3, 301)
    assert np.isfinite(D(large, ts, fx.solve_limit(large, ts).z))


@pytest.mark.parametrize("effect", [fx.effects.Inertia(1e-3), fx.effects.Noise(1e-6)])
def test_the_limit_of_a_scene_with_effects(effect):
    """Mass vanishes in it; noise has friction, and no curve of the limit."""
    scene = SCENE.replace(effects=(effect,))
    assert float(K(scene, 0.05)) == float(K(SCENE, 0.05))
    if isinstance(effect, fx.effects.Inertia):
        found = fx.solve_limit(scene, TS)
        assert D(scene, TS, found.z) == pytest.approx(
            float(found.dissipation[-1]), rel=1e-5
        )
    else:
        with pytest.raises(ValueError, match=r"principle.D does not do Noise"):
            D(scene, TS, 0 * TS)


@pytest.mark.parametrize(
    ("call", "named"),
    [
        (lambda: D(SCENE, [0.0, 0.0], [0.0, 0.0]), "ts = "),
        (lambda: D(SCENE, [0.0, 4.0], [0.0, 0.0]), "ts = "),
        (lambda: D(SCENE, [0.0, 1.0], [0.0, np.nan]), "z = "),
        (lambda: D(SCENE, [0.0, 1.0], [0.0]), "z = "),
        (lambda: D_eps(SCENE, 0.0, 1.0, [0.0, 1.0], [0.0, 0.0]), "eps = 0"),
        (lambda: D_eps(SCENE, 0.1, -1.0, [0.0, 1.0], [0.0, 0.0]), "gamma = -1"),
        (
            lambda: D_eps(SCENE, 1e-9, 1.0, [0.0, 1.0], [0.0, 1.0]),
            "pieces of its way = ",
        ),
    ],
)
def test_bad_curves_are_named(call, named):
    with pytest.raises(ValueError, match=named):
        call()


@pytest.mark.slow
def test_parts_of_any_kind():
    for kind in ("custom", "vertical", "homothetic"):
        profile, bristle = pair("spline", kind, 1, 2)
        scene = SCENE.replace(profile=profile, bristle=bristle)
        found = fx.solve_limit(scene, TS)
        dissipated = float(found.dissipation[-1])
        assert D(scene, TS, found.z) == pytest.approx(dissipated, rel=1e-4)
