"""Rules of derivatives see the numbers that functions hold beside their arguments."""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import pytest

import frictionjax as fx
from frictionjax._compile import hoisted, strong_arrays


def wave(y, k):
    return k**2 * jnp.sin(y)


class Holder:
    def __init__(self, k):
        self.k = k

    def of(self, y):
        return wave(y, self.k)


def with_default(k):
    def fn(y, k=k):
        return wave(y, k)

    return fn


KINDS = {
    "closure": lambda k: lambda y: wave(y, k),
    "closure of a closure": lambda k: (lambda fn: lambda y: fn(y))(with_default(k)),
    "default": with_default,
    "partial": lambda k: partial(wave, k=k),
    "method": lambda k: Holder(k).of,
    "of two": lambda k: lambda eps, y: wave(y, k) + 0 * eps,
}


@eqx.filter_custom_vjp
def last(parts):
    fn, args = parts
    return fn(*args)


@last.def_fwd
def _forth(perturbed, parts):
    return last.fn(parts), None


@last.def_bwd
def _back(known, by, perturbed, parts):
    moving, still = eqx.partition(parts, eqx.is_inexact_array)
    return jax.vjp(lambda m: last.fn(eqx.combine(m, still)), moving)[1](by)[0]


@pytest.mark.parametrize("kind", KINDS)
def test_numbers_of_functions_go_through_rules_of_derivatives(kind):
    args = [jnp.asarray(0.3)] * (2 if kind == "of two" else 1)

    def value(k):
        return last(strong_arrays(hoisted((KINDS[kind](k), args))))

    exact = 2 * 0.7 * jnp.sin(0.3)
    assert jax.grad(value)(0.7) == pytest.approx(float(exact), rel=1e-14)
    assert jax.grad(jax.jit(value))(0.7) == pytest.approx(float(exact), rel=1e-14)


def test_functions_of_known_numbers_stay_themselves():
    fn = KINDS["closure"](0.7)
    assert hoisted([fn, jnp.sin, 1.0])[0] is fn


@pytest.mark.slow  # programs of their own, 10 s each
@pytest.mark.parametrize("where", ["solve", "steady_slide"])
def test_trajectories_and_slides_have_derivatives_by_what_a_function_closes_over(where):
    bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)

    def of(surface):
        if where == "steady_slide":
            return fx.steady_slide(surface, bristle, 0.05).mean_plus
        parts = surface, bristle, fx.supports.Spring(1.0), fx.loads.Sine(1.05, 3.0)
        return fx.solve(fx.Scene(*parts, 3.0), 0.05, ts=[0.0, 0.5, 1.0]).z[-1]

    def closed(k):
        slope = k / (2 * jnp.pi)
        return of(fx.profiles.Custom(lambda y: slope * jnp.sin(2 * jnp.pi * y)))

    expected = float(jax.grad(lambda k: of(fx.profiles.Sine(k)))(0.1))
    assert jax.grad(closed)(0.1) == pytest.approx(expected, rel=1e-6)
    assert jax.jit(jax.grad(closed))(0.1) == pytest.approx(expected, rel=1e-6)
