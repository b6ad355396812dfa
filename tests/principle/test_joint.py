"""M and K of scenes: what a motion under a force dissipates at least."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from samples import pair

import frictionjax as fx
from frictionjax.principle.well_variation import well_variation

M_, K = fx.principle.M, fx.principle.K
SPRING, LOAD = fx.supports.Spring(1.0), fx.loads.Sine(1.05, 3.0)


def scene_of(profile, bristle, support=SPRING, load=LOAD):
    return fx.Scene(profile, bristle, support, load, 3.0)


def test_M_bounds_the_power_and_meets_it_while_sliding():
    scene = scene_of(*pair("fourier", "angular", 1, 3))
    found = fx.friction(scene)

    def M(v, xi):
        return float(M_(scene, v, xi))

    plus, minus = float(found.rho_plus), float(found.rho_minus)
    assert M(2.0, plus) == pytest.approx(2 * plus, rel=1e-13)
    assert M(-2.0, minus) == pytest.approx(-2 * minus, rel=1e-13)
    assert M(2.0, 0.5 * plus) > plus
    assert M(0.0, 0.5 * plus) == 0
    assert M(0.0, 1.001 * plus) == np.inf
    assert M(1.0, 1.001 * minus) == np.inf
    wide = float(plus - minus)
    assert np.isfinite(M(1.0, plus + 1e-12 * wide))
    assert np.isfinite(M(1.0, minus - 1e-12 * wide))
    assert M(1.0, plus + 1e-9 * wide) == M(1.0, minus - 1e-9 * wide) == np.inf
    near = M_(scene, 1.0, plus + 1e-9 * wide, slack=2e-9 * wide)
    assert near == pytest.approx(float(M(1.0, plus)), rel=1e-12)


@pytest.mark.parametrize(("stiffness", "amplitude"), [(1.0, 1.0488), (1e4, 1e4)])
def test_what_the_limit_dissipates_on_its_slides_is_finite(stiffness, amplitude):
    """xi = l - Phi'(z) is rho but for rounding there: M = rho v, and K(rho) = rho."""
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(stiffness),
        fx.loads.Sine(amplitude, 3.0),
        3.0,
    )
    ts = np.linspace(0.0, 3.0, 1501)
    z = np.asarray(fx.solve_limit(scene, ts).z)
    speed = np.diff(z, prepend=z[0])
    slides = np.flatnonzero(speed)
    xi = np.asarray(jax.vmap(scene.load)(ts))[slides] - stiffness * z[slides]
    assert slides.size > 500
    rate = M_(scene, speed[slides][:500], xi[:500])
    assert rate == pytest.approx(0.1 * np.abs(speed[slides][:500]), rel=1e-7)


@pytest.mark.parametrize("stiffness", [2.0, 2e-3])
@pytest.mark.parametrize("rate", [1e4, 1e6, 1e9])
def test_loads_far_above_rho_are_told_by_the_load(rate, stiffness):
    """At l = 1e6 N one spacing of floats is 1e-10 N: 1,159 of 1,201 were infinite."""
    parts = fx.profiles.Sine(0.1), fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    scene = scene_of(*parts)
    load = 0.7 + rate * np.linspace(1.0, 2.0, 101)
    z = (load - 0.1) / stiffness
    xi = load - stiffness * z
    speed = np.full(101, rate / stiffness)
    told = M_(scene, speed, xi, load=load)
    assert np.all(np.isfinite(told))
    wrong = M_(scene, speed, xi + 20 * np.spacing(2 * rate) + 1e-9, load=load)
    assert np.all(np.isinf(wrong))


@pytest.mark.parametrize(
    "kind",
    [
        "given",
        *(
            pytest.param(kind, marks=pytest.mark.slow)
            for kind in ("slanted", "angular", "array")
        ),
    ],
)
def test_K_of_a_scene_is_that_of_its_potential(kind):
    """Of tables, in one program, at any number of forces of any shape."""
    if kind == "given":
        given = fx.GivenPotential(lambda Y: 0.02 * jnp.sin(2 * jnp.pi * Y), points=256)
        scene = fx.Scene(potential=given, support=SPRING, load=LOAD, duration=3.0)
    else:
        scene = scene_of(*pair("fourier", "slanted" if kind == "array" else kind, 1, 5))
    if kind == "array":
        two = fx.effects.RigidArray(jnp.asarray([0.0, 0.3]))
        scene = scene.replace(effects=(two,))
    found = fx.friction(scene)
    xi = float(found.rho_minus) + float(found.rho_plus - found.rho_minus) * np.linspace(
        -0.2, 1.2, 70
    )
    told = K(scene, xi.reshape(2, 35))
    assert told.shape == (2, 35)
    if kind == "array":  # brute: the mean over a period of both tips
        Y = (np.arange(1 << 14) + 0.5) / (1 << 14)
        slope = scene.potential.W
        each = jax.vmap(jax.grad(lambda y: slope(y)))
        force = np.asarray(each(Y) + each(Y + 0.3))
        expected = [np.mean(np.abs(x - force)) for x in xi]
        np.testing.assert_allclose(told.ravel(), expected, atol=1e-6 * np.max(xi))
    else:
        law = jax.jit(jax.vmap(lambda x: well_variation(scene.potential, x)))
        np.testing.assert_allclose(told.ravel(), law(jnp.asarray(xi)), rtol=1e-12)
    assert float(K(scene, float(xi[7]))) == pytest.approx(float(told.ravel()[7]), rel=1e-14)


def test_K_and_M_have_derivatives():
    scene = scene_of(fx.profiles.Sine(0.2), fx.bristles.Homothetic(1.0))
    for xi in (-0.15, 0.0, 0.1):
        expected = 2 / np.pi * np.arcsin(xi / 0.2)
        assert float(jax.grad(lambda x: K(scene, x))(xi)) == pytest.approx(
            expected, abs=1e-6
        )
        slope = jax.grad(lambda x: M_(scene, -3.0, x))(xi)
        assert float(slope) == pytest.approx(3 * expected, abs=3e-6)

    def by_alpha(alpha):
        return K(scene_of(fx.profiles.Sine(0.2), fx.bristles.Homothetic(alpha)), 0.0)

    # 2 rho/pi with rho = 0.2 alpha
    assert float(jax.grad(by_alpha)(1.3)) == pytest.approx(0.4 / np.pi, rel=1e-9)


def test_M_eps_is_both_parts_and_bounds_the_power():
    rng = np.random.default_rng(0)
    v, xi = rng.normal(size=(2, 50))
    eps, gamma = 10.0 ** -rng.uniform(1, 3, 50), rng.uniform(0.5, 2, 50)
    found = fx.principle.M_eps(v, xi, eps, gamma)
    parts = fx.principle.R_eps(v, eps, gamma) + fx.principle.R_eps_star(xi, eps, gamma)
    np.testing.assert_allclose(found, parts, rtol=1e-14)
    assert np.all(found >= v * xi)
    met = fx.principle.M_eps(v, eps**gamma * v, eps, gamma)
    np.testing.assert_allclose(met, eps**gamma * v**2, rtol=1e-14)


@pytest.mark.parametrize(
    ("call", "named"),
    [
        (lambda p, s: p.K(s, "x"), "xi = 'x'"),
        (lambda p, s: p.K(s, np.nan), "xi = nan"),
        (lambda p, s: p.M(s, 1.0, True), "xi = True"),
        (lambda p, s: p.M(s, [np.inf], 0.1), "v = "),
        (lambda p, s: p.R(s, None), "v = None"),
        (lambda p, s: p.R_star(s, []), "xi = "),
        (lambda p, s: p.R_eps(1.0, -1.0, 1.0), "eps = -1"),
        (lambda p, s: p.R_eps_star(1.0, 0.1, 0.0), "gamma = 0"),
        (lambda p, s: p.M_eps(1.0, 1.0, [0.1, 0.0], 1.0), "eps = "),
        (lambda p, s: p.K(s.profile, 0.1), "scene"),
        (lambda p, s: p.M(s, [1.0, 2.0], [0.1, 0.1, 0.1]), "shapes that broadcast"),
        (lambda p, s: p.M_eps([1.0, 2.0], 0.1, [0.1, 0.1, 0.1], 1.0), "shapes that"),
        (lambda p, s: p.M(s, 1.0, 0.1, slack=-1.0), "slack = -1"),
    ],
)
def test_bad_arguments_are_named(call, named):
    scene = scene_of(fx.profiles.Sine(0.2), fx.bristles.Homothetic(1.0))
    with pytest.raises(ValueError, match=named):
        call(fx.principle, scene)
