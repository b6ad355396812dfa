"""Step sizes on a grid, 2^(level/8) of a first one, in arithmetic that XLA vectorises."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array

from ..._checks import Real
from .settings import SETTINGS

_BIAS, _FRACTION = 1023, (1 << 52) - 1
_NODES = 0.5 - 0.5 * np.cos(np.pi * (np.arange(16) + 0.5) / 16)
_LOG2 = tuple(np.polyfit(_NODES, np.log2(1 + _NODES), 7))
_EXP2 = tuple(np.polyfit(_NODES, np.exp2(_NODES), 7))


def _horner(coefficients: tuple[float, ...], x: Real) -> Real:
    total = jnp.full_like(x, coefficients[0])
    for coefficient in coefficients[1:]:
        total = total * x + coefficient
    return total


def log2(x: Real) -> Real:
    """`log2(x)` of a normal positive float64 to 1e-6, enough to steer steps."""
    bits = lax.bitcast_convert_type(x, jnp.int64)
    exponent = (bits >> 52) - _BIAS
    mantissa = lax.bitcast_convert_type((bits & _FRACTION) | (_BIAS << 52), jnp.float64)
    return exponent.astype(jnp.float64) + _horner(_LOG2, mantissa - 1)


def exp2_in_bits(x: Real) -> Real:
    """`2^x` to 1e-8 for |x| < 1020, the same bits for the same x."""
    whole = jnp.floor(x)
    power = lax.bitcast_convert_type((whole.astype(jnp.int64) + _BIAS) << 52, jnp.float64)
    return power * _horner(_EXP2, x - whole)


def step_of(level: Real, first: Real | float) -> Real:
    """The step at a level of the grid that starts at the step `first`."""
    return first * exp2_in_bits(level / SETTINGS.per_octave)


def rounded_down(step: Any) -> Array:
    """The largest step of the grid that starts at 1, up to `step`."""
    # A hair above the grid point counts as on it: products of grid steps land there.
    octaves = jnp.log2(jnp.maximum(step, 1e-300))
    level = jnp.floor(SETTINGS.per_octave * octaves + 1e-6)
    return jnp.exp2(level / SETTINGS.per_octave)
