"""`F(eps W + eps^2 Q) - F(0)` by its expansion: an identity, with all digits."""

from fractions import Fraction

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.numerics import LeadingTerm, RestTerm


def energy(u):
    return 2.0 + 1.5 * u - 0.7 * u**2 + 0.25 * u**3


def wave(Y):
    return 0.3 * jnp.sin(2 * jnp.pi * Y)


def second(eps, Y):
    return jnp.cos(2 * jnp.pi * Y) / (1 + eps)


@eqx.filter_jit
def at(term, eps, Y):
    return term(eps, Y)


@pytest.mark.parametrize("eps", [0.1, 1e-3, 1e-6, 1e-8])
@pytest.mark.parametrize("rest", [None, second])
def test_all_digits_at_any_eps(eps, rest):
    """The polynomial in exact arithmetic: W and Q are what is left of it."""
    leading = LeadingTerm(energy, wave)
    term = RestTerm(leading, rest)
    for Y in np.linspace(0.05, 0.95, 7):
        WW, e = Fraction(float(wave(Y))), Fraction(eps)
        QQ = Fraction(0) if rest is None else Fraction(float(rest(eps, Y)))
        u = e * WW + e**2 * QQ
        change = Fraction(1.5) * u - Fraction(0.7) * u**2 + Fraction(0.25) * u**3
        exact = (change - e * Fraction(1.5) * WW) / e**2
        found = float(at(term, jnp.asarray(eps), jnp.asarray(Y)))
        assert float(leading(jnp.asarray(Y))) == pytest.approx(1.5 * float(WW), rel=1e-15)
        assert found == pytest.approx(float(exact), rel=1e-12, abs=1e-15)


def quadratic(u):
    return 0.5 * (1 + u) ** 2 - 0.5


def exponential(u):
    return jnp.exp(u) - 1


@pytest.mark.parametrize("eps", [1e-2, 1e-4, 1e-6, 1e-8])
def test_energies_that_cancel_inside_keep_their_digits(eps):
    """F(0) = 0 out of a difference: what it loses, no bound knows."""
    term = RestTerm(LeadingTerm(quadratic, wave), None)
    found = float(at(term, jnp.asarray(eps), jnp.asarray(0.23)))
    assert found == pytest.approx(0.5 * float(wave(0.23)) ** 2, rel=1e-12)
    term = RestTerm(LeadingTerm(exponential, wave), None)
    found, WW = float(at(term, jnp.asarray(eps), jnp.asarray(0.23))), float(wave(0.23))
    u = eps * WW
    series = 0.5 + u / 6 + u**2 / 24 + u**3 / 120 + u**4 / 720
    assert found == pytest.approx(WW**2 * series, rel=1e-11)


def test_it_has_derivatives():
    term = RestTerm(LeadingTerm(energy, wave), second)
    Y, h = 0.3, 1e-5
    slope = jax.jit(jax.grad(lambda y: term(jnp.asarray(1e-2), y)))(Y)
    both = [float(at(term, jnp.asarray(1e-2), jnp.asarray(Y + s * h))) for s in (1, -1)]
    assert float(slope) == pytest.approx((both[0] - both[1]) / (2 * h), rel=1e-8)
