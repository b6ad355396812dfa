"""Loads given by the far end of the horizontal spring."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

Q = fx.loads.Sine(1.2, 3.0)
SURFACE = fx.profiles.Sine(0.1)
ROD = fx.bristles.AngularSpring(1.0, 1.25, 1.0, 0.1)
T = np.linspace(0, 3, 13)


def scene(load=None, bristle=ROD, stiffness=2.0, z0=-1.0):
    load = fx.loads.Pulled(Q, 0.25) if load is None else load
    return fx.Scene(SURFACE, bristle, fx.supports.Spring(stiffness), load, 3.0, z0)


def test_the_load_is_what_the_spring_pulls_with():
    load = scene().load
    expected = 2.0 * (1.2 * np.sin(2 * np.pi * T / 3) - 0.25 - 0.75)
    np.testing.assert_allclose(jax.vmap(load)(T), expected, atol=1e-14)
    turns = scene().turning_points()
    np.testing.assert_allclose(turns[:2], [0.75, 2.25])


@pytest.mark.parametrize(
    ("bristle", "constant"),
    [
        (fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0), -np.tan(1.0)),
        (fx.bristles.VerticalSpring(1.0, 2.0, 1.0), 0.0),
        (fx.bristles.Homothetic(1.0), 0.0),
    ],
)
def test_every_bristle_has_its_constant(bristle, constant):
    load = scene(bristle=bristle, z0=0.0).load
    assert float(load(0.0)) == pytest.approx(2.0 * (constant - 0.25), rel=1e-15)


def test_other_parts_make_another_load():
    stiffer = scene().replace(support=fx.supports.Spring(3.0))
    assert float(stiffer.load(0.0)) == pytest.approx(-3.0)
    shorter = scene().replace(bristle=fx.bristles.VerticalSpring(1.0, 2.0, 1.0), z0=0.0)
    assert float(shorter.load(0.0)) == pytest.approx(-0.5)
    by_leaf = eqx.tree_at(lambda s: s.support.stiffness, scene(), jnp.asarray(3.0))
    there = fx.solve_limit(by_leaf, [0.75]).z[0]
    assert float(there) == pytest.approx(float(fx.solve_limit(stiffer, [0.75]).z[0]))


def test_it_is_solved_as_any_other_load():
    times, places = np.array([0.0, 0.7, 2.0, 3.0]), np.array([0.0, 1.0, -1.0, 0.0])
    points = fx.loads.PiecewiseLinear(times, places)
    pulled = scene(fx.loads.Pulled(points, 0.25), z0=-1.02)
    plain = pulled.replace(load=fx.loads.PiecewiseLinear(times, 2 * (places - 1.0)))
    found, same = (fx.solve(one, 0.05, ts=T) for one in (pulled, plain))
    assert found.ok
    np.testing.assert_allclose(found.z, same.z, rtol=1e-12)
    limit, other = (fx.solve_limit(one, T) for one in (pulled, plain))
    np.testing.assert_allclose(limit.z, other.z, rtol=1e-14)
    assert np.max(np.abs(found.z - limit.z)) < 0.1


def test_a_place_may_be_a_function():
    place = fx.loads.Custom(lambda t: 1.2 * jnp.sin(2 * jnp.pi * t / 3))
    pulled = scene(fx.loads.Pulled(place, 0.25))
    assert pulled.turns == scene().turns
    same = fx.solve_limit(scene(), T)
    np.testing.assert_allclose(fx.solve_limit(pulled, T).z, same.z, atol=1e-13)


def test_derivatives_go_through_the_spring_and_the_bristle():
    """On a slide z = q - L_h + c - rho_plus/k."""
    whole = scene()

    @eqx.filter_grad
    def slope(scene):
        return fx.solve_limit(scene, jnp.asarray([0.5])).z[0]

    found = slope(whole)
    rho = float(fx.friction(whole).rho_plus)
    assert float(found.support.stiffness) == pytest.approx(rho / 4.0, rel=1e-12)
    assert float(found.load.rest_length) == pytest.approx(-1.0, rel=1e-12)

    def by_length(length):
        other = whole.replace(bristle=ROD.replace(length=length), z0=-1.0)
        return float(fx.solve_limit(other, [0.5]).z[0])

    by_hand = (by_length(1.25 + 1e-6) - by_length(1.25 - 1e-6)) / 2e-6
    assert float(found.bristle.length) == pytest.approx(by_hand, rel=1e-6)


def test_what_cannot_be_pulled_is_refused():
    with pytest.raises(ValueError, match=r"load.position = 'float'"):
        fx.loads.Pulled(1.0)
    with pytest.raises(ValueError, match=r"load.position = 'Pulled'"):
        fx.loads.Pulled(fx.loads.Pulled(Q))
    with pytest.raises(ValueError, match=r"load.rest_length = inf"):
        fx.loads.Pulled(Q, np.inf)
    with pytest.raises(ValueError, match=r"load = 'Pulled': needs a Scene"):
        fx.loads.Pulled(Q)(0.0)
    convex = fx.supports.Convex(lambda z: z**2)
    with pytest.raises(ValueError, match=r"scene.support = 'Convex': needs a Spring"):
        fx.Scene(SURFACE, ROD, convex, fx.loads.Pulled(Q), 3.0)
