"""Which sampled curves are solutions of the limit system, and which are not."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from samples import pair

import frictionjax as fx

SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.05, 3.0),
    3.0,
)
LAW = fx.friction(SCENE)
WIDTH = float(LAW.rho_plus - LAW.rho_minus)
TS = np.linspace(0.0, 3.0, 301)
Z = np.asarray(fx.solve_limit(SCENE, TS).z)
SUPPORTS = {
    "spring": fx.supports.Spring(2.0),
    "convex": fx.supports.Convex(lambda z: 0.5 * z**2 + 0.1 * z**4),
}
LOADS = {
    "sine": fx.loads.Sine(1.05, 1.1),
    "triangle": fx.loads.Triangle(0.9, 1.3),
    "function": fx.loads.Custom(lambda t: jnp.sin(5 * t) * t),
}


@pytest.mark.parametrize("count", [2, 17, 301, 20001])
def test_solutions_are_accepted_however_thinly_sampled(count):
    ts = np.linspace(0.0, 3.0, count)
    found = fx.certify_limit(SCENE, ts, fx.solve_limit(SCENE, ts).z)
    assert found.ok
    assert found.distance < 1e-13
    assert found.excess < 1e-13
    assert 0 <= found.residual < 1e-13 * found.scale
    assert found.scale == pytest.approx(WIDTH**2, rel=1e-12)  # the spring has 1 N/m


@pytest.mark.parametrize("support", SUPPORTS)
@pytest.mark.parametrize("load", LOADS)
def test_solutions_of_any_parts_are_accepted(support, load):
    parts = pair("fourier", "vertical", 1, 4)
    scene = fx.Scene(*parts, SUPPORTS[support], LOADS[load], 3.0)
    ts = np.sort(np.random.default_rng(1).uniform(0, 3, 40))
    found = fx.certify_limit(scene, ts, fx.solve_limit(scene, ts).z)
    assert found.ok, found
    assert found.distance < 1e-9


def test_solutions_of_any_start_are_accepted():
    for start in (-0.05, 0.0, 0.08):
        z = fx.solve_limit(SCENE.replace(z0=start), TS).z
        assert fx.certify_limit(SCENE, TS, z).distance < 1e-13


def test_the_distance_is_that_of_the_nearest_solution():
    """Of noise of one sign and of both, against all starts, one by one."""
    rng = np.random.default_rng(0)
    starts = np.linspace(-0.12, 0.087, 415)
    ts = np.linspace(0.0, 3.0, 61)
    each = [np.asarray(fx.solve_limit(SCENE.replace(z0=s), ts).z) for s in starts]
    for low, high in ((-0.02, 0.02), (0.0, 0.03), (-0.01, 0.0)):
        z = each[300] + rng.uniform(low, high, ts.size)
        brute = min(np.max(np.abs(z - one)) for one in each) / WIDTH
        found = fx.certify_limit(SCENE, ts, z).distance
        assert found == pytest.approx(brute, abs=0.6 * (starts[1] - starts[0]) / WIDTH)


def test_at_rest_one_place_has_to_be_near_all_samples():
    """Where nothing is forgotten: half of the way from the lowest sample to the highest."""
    still = SCENE.replace(load=fx.loads.Sine(0.02, 3.0))
    z = np.where(np.arange(TS.size) < 100, 0.004, -0.006)
    found = fx.certify_limit(still, TS, z)
    assert found.distance == pytest.approx(0.005 / WIDTH, rel=1e-9)
    assert found.status.name == "OFF"


@pytest.mark.parametrize("size", [0.5, 2.0])
def test_noise_is_told_by_its_size(size):
    noise = size * 1e-3 * WIDTH * np.random.default_rng(3).choice([-1, 1], TS.size)
    found = fx.certify_limit(SCENE, TS, Z + noise)
    assert found.ok == (size < 1)
    assert found.distance == pytest.approx(size * 1e-3, rel=0.01)
    assert fx.certify_limit(SCENE, TS, Z + noise, tolerance=3e-3).ok


WRONG = {
    "shifted": (lambda: Z + 0.01, "OUTSIDE"),
    "at rest": (lambda: 0 * Z, "OUTSIDE"),
    "late": (lambda: np.interp(TS, TS - 0.02, Z), "OFF"),
    "dragged": (lambda: np.asarray(jax.vmap(SCENE.load)(TS)), "OFF"),
    "other friction": (lambda: solution_of(0.11), "OUTSIDE"),
    "less friction": (lambda: solution_of(0.09), "OFF"),
    "nan": (lambda: np.where(TS[7] == TS, np.nan, Z), "NOT_FINITE"),
}


def solution_of(slope):
    return np.asarray(fx.solve_limit(SCENE.replace(profile=fx.profiles.Sine(slope)), TS).z)


@pytest.mark.parametrize("name", WRONG)
def test_wrong_curves_are_told_and_why(name):
    curve, status = WRONG[name]
    found = fx.certify_limit(SCENE, TS, curve())
    assert not found.ok
    assert found.status.name == status
    if status != "NOT_FINITE":
        assert max(found.shares.values()) > 1
        assert found.status.message == found.message


def test_a_curve_that_moves_without_the_force_misses_energy():
    """Dragged through the middle of the strip: all that friction takes is missing."""
    z = np.asarray(jax.vmap(SCENE.load)(TS))
    moves = np.diff(z)
    rho = np.where(moves > 0, float(LAW.rho_plus), float(LAW.rho_minus))
    found = fx.certify_limit(SCENE, TS, z)
    # Each gap has the loads of both of its ends: a little less is missing for sure.
    assert found.residual == pytest.approx(np.sum(rho * moves), rel=0.2)
    fine = np.linspace(0, 3, 6001)
    finer = fx.certify_limit(SCENE, fine, np.asarray(jax.vmap(SCENE.load)(fine))).residual
    assert found.residual < finer
    assert finer == pytest.approx(np.sum(rho * moves), rel=0.01)


@pytest.mark.parametrize("eps", [1e-2, 1e-3, 1e-4])
def test_motions_at_finite_eps_come_nearer(eps):
    z = fx.solve(SCENE, eps, ts=TS).z
    found = fx.certify_limit(SCENE, TS, z, tolerance=2 * eps / WIDTH)
    assert found.ok
    assert found.distance > 0.1 * eps / WIDTH
    assert not fx.certify_limit(SCENE, TS, z, tolerance=0.1 * eps / WIDTH).ok


def test_what_it_shows():
    found = fx.certify_limit(SCENE, TS, Z)
    assert "OK: the curve solves the limit system" in repr(found)
    assert "tolerance" in str(found.table())
    figure = fx.plot.draw_certificate(fx.certify_limit(SCENE, TS, Z + 0.01))
    assert figure.axes[0].get_title(loc="left").startswith("OUTSIDE")


@pytest.mark.parametrize(
    ("ts", "z", "named", "more"),
    [
        ([0.0], [0.0], "ts = ", {}),
        ([0.0, 0.0], [0.0, 0.0], "ts = ", {}),
        ([0.0, 9.0], [0.0, 0.0], "ts = ", {}),
        ([0.0, 1.0], [0.0], "z = ", {}),
        ([0.0, 1.0], ["a", "b"], "z = ", {}),
        ([0.0, 1.0], [0.0, 0.0], "tolerance = 0", {"tolerance": 0.0}),
    ],
)
def test_bad_arguments_are_named(ts, z, named, more):
    with pytest.raises(ValueError, match=named):
        fx.certify_limit(SCENE, ts, z, **more)
