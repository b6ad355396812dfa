"""Taylor remainders at zero without cancellation."""

from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np

from .._checks import Real
from .settings import SETTINGS

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_NODES, _WEIGHTS = 0.5 * (_NODES + 1), 0.5 * _WEIGHTS  # on [0, 1]
_FEWER_NODES, _FEWER_WEIGHTS = np.polynomial.legendre.leggauss(8)
_FEWER_NODES, _FEWER_WEIGHTS = 0.5 * (_FEWER_NODES + 1), 0.5 * _FEWER_WEIGHTS


def _derivative(fn: Callable[[Real], Real]) -> Callable[[Real], Real]:
    return lambda x: jax.jvp(fn, (x,), (jnp.ones_like(x),))[1]


def increment(fn: Callable[[Real], Real], x: Real) -> Real:
    """`fn(x) - fn(0)` with a small relative error at small x, derivatives exact.

    The difference loses log10(|fn(0)|/|increment|) digits. Its integral form
    x int_0^1 fn'(s x) ds loses none, but the quadrature is only as good as fn is smooth
    over [0, x]: it is taken where it agrees with the difference to the rounding error
    that the difference has. (Always the difference: 8 digits lost at eps = 1e-8. Always
    the quadrature: good to 16 digits only well inside the domain of fn.)
    """
    end, origin = fn(x), fn(jnp.zeros_like(x))
    difference = end - origin
    slopes = jax.vmap(_derivative(fn))(x * _NODES)
    integral = x * jnp.dot(_WEIGHTS, slopes)
    bound = SETTINGS.cancelled * (jnp.abs(end) + jnp.abs(origin))
    agrees = jnp.abs(integral - difference) <= bound
    correction = jnp.where(agrees, integral - difference, 0.0)
    return difference + jax.lax.stop_gradient(correction)


def second_remainder(fn: Callable[[Real], Real], x: Real) -> Real:
    """`(fn(x) - fn(0) - fn'(0) x)/x^2`, which is `fn''(0)/2` at x = 0.

    The integral form int_0^1 (1 - s) fn''(s x) ds, replaced by the quotient where x is too
    large for the quadrature: where half as many nodes say otherwise, and the two differ by
    more than the rounding error of the quotient. (That alone: values of fn may be small by
    cancellation inside it, (1 + x)^2/2 - 1/2 say, which its bound knows nothing of; 5e3
    times the remainder was lost at x = 1e-10.)
    """
    zero = jnp.zeros_like(x)
    bend = jax.vmap(_derivative(_derivative(fn)))
    integral = jnp.dot(_WEIGHTS * (1 - _NODES), bend(x * _NODES))
    rough = jnp.dot(_FEWER_WEIGHTS * (1 - _FEWER_NODES), bend(x * _FEWER_NODES))
    end, origin, linear = fn(x), fn(zero), _derivative(fn)(zero) * x
    square = jnp.where(x == 0, 1.0, x * x)
    quotient = (end - origin - linear) / square
    bound = SETTINGS.cancelled * (jnp.abs(end) + jnp.abs(origin) + jnp.abs(linear))
    agrees = jnp.abs(integral - quotient) * x * x <= bound
    settled = jnp.abs(integral - rough) <= SETTINGS.settled * jnp.abs(integral)
    return jnp.where(agrees | settled, integral, quotient)


def mean_slope(fn: Callable[[Real], Real], start: Real, end: Real) -> Real:
    """`(fn(end) - fn(start))/(end - start)`, which is `fn'(start)` at end = start.

    The integral form int_0^1 fn'(start + s (end - start)) ds, replaced by the quotient
    where the two differ by more than the rounding error of the quotient.
    """
    width = end - start
    slopes = jax.vmap(_derivative(fn))(start + width * _NODES)
    integral = jnp.dot(_WEIGHTS, slopes)
    last, first = fn(end), fn(start)
    quotient = (last - first) / jnp.where(width == 0, 1.0, width)
    bound = SETTINGS.cancelled * (jnp.abs(last) + jnp.abs(first) + jnp.abs(integral))
    agrees = jnp.abs((integral - quotient) * width) <= bound
    return jnp.where(agrees, integral, quotient)
