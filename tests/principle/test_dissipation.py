"""R, R*, R_eps and R_eps*: potentials, and that each is the other's dual."""

import jax
import numpy as np
import pytest

import frictionjax as fx

P = fx.principle
SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.05, 3.0),
    3.0,
)
LAW = fx.friction(SCENE)
PLUS, MINUS = float(LAW.rho_plus), float(LAW.rho_minus)


def test_R_is_friction_times_speed():
    v = np.array([[-2.0, 0.0], [1.0, 3.0]])
    found = P.R(SCENE, v)
    assert found.shape == v.shape
    np.testing.assert_allclose(found, np.where(v > 0, PLUS * v, MINUS * v), rtol=1e-15)
    assert float(jax.grad(lambda v: P.R(SCENE, v))(-0.5)) == pytest.approx(MINUS)


def test_R_star_is_the_dual_of_R():
    """The largest of xi v - R(v) over all v: 0 inside the interval, no bound outside."""
    v = np.linspace(-1e6, 1e6, 2001)
    xi = np.array([MINUS, 0.5 * MINUS, 0.0, 0.9 * PLUS, PLUS, 1.01 * PLUS, 1.01 * MINUS])
    dual = np.max(xi[:, None] * v - np.asarray(P.R(SCENE, v)), axis=1)
    found = np.asarray(P.R_star(SCENE, xi))
    assert np.all(np.isinf(found) == (dual > 100.0))
    assert np.all(found[:5] == 0.0)


def test_the_edge_of_the_interval_is_friction_but_for_rounding():
    wide = PLUS - MINUS
    near = np.array([PLUS + 1e-11 * wide, MINUS - 1e-11 * wide])
    far = np.array([PLUS + 1e-9 * wide, MINUS - 1e-9 * wide])
    assert np.all(P.R_star(SCENE, near) == 0)
    assert np.all(np.isinf(P.R_star(SCENE, far)))


def test_R_eps_star_is_the_dual_of_R_eps():
    eps, gamma, xi = 0.01, 1.5, 0.03
    peak = xi / eps**gamma
    v = peak * np.linspace(0.5, 1.5, 1001)
    dual = np.max(xi * v - np.asarray(P.R_eps(v, eps, gamma)))
    assert float(P.R_eps_star(xi, eps, gamma)) == pytest.approx(dual, rel=1e-12)
    assert float(jax.grad(lambda v: P.R_eps(v, eps, gamma))(peak)) == pytest.approx(xi)
