"""Sine and cosine of whole turns, as one pair that XLA vectorises."""

import math
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from .zero_tangents import is_zero

# Taylor series of sin(2 pi r) and cos(2 pi r): on |r| <= 1/8 the first terms left out
# are 3e-19 and 3e-18.
_SINE = tuple(
    (-1) ** k * (2 * math.pi) ** (2 * k + 1) / math.factorial(2 * k + 1) for k in range(9)
)
_COSINE = tuple(
    (-1) ** k * (2 * math.pi) ** (2 * k) / math.factorial(2 * k) for k in range(9)
)

# Harmonics in groups whose powers are there, groups by Horner's rule, blocks of groups in a
# loop where there are more. XLA copies cheap chains into each of their users, so a chain of
# n harmonics doubles n times: with 8 by Horner's rule alone LLVM wants more than 20 GB for
# a lane's step, with 14 by the addition theorem, and for tips with mass with 4 where no
# factor z stands outside of the sum. Microseconds of a step of 8 and 16 harmonics: 0.145
# and 0.183 in groups of 4, 0.148 and - by the addition theorem, 0.19 for 16 in groups of 8,
# 0.28 by Horner's rule in a loop over blocks of 8.
_GROUP, _BLOCK = 4, 16


def _horner(
    coefficients: tuple[float, ...], x: Float[Array, "*shape"]
) -> Float[Array, "*shape"]:
    total = jnp.full_like(x, coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        total = total * x + coefficient
    return total


@jax.jit  # traced and lowered once, not at every use: up to a tenth of a first solve
def _evaluate(
    y: Float[Array, "*shape"],
) -> tuple[Float[Array, "*shape"], Float[Array, "*shape"]]:
    quarter = jnp.round(4 * y)
    r = y - 0.25 * quarter  # exact: both are multiples of the spacing of floats at y
    square = r * r
    sine = r * _SINE[0] + r * (square * _horner(_SINE[1:], square))
    cosine = 1 + square * _horner(_COSINE[1:], square)
    quadrant = quarter - 4 * jnp.floor(0.25 * quarter)
    swapped = (quadrant == 1) | (quadrant == 3)
    sine, cosine = jnp.where(swapped, cosine, sine), jnp.where(swapped, sine, cosine)
    sine = jnp.where(quadrant >= 2, -sine, sine)
    return sine, jnp.where((quadrant == 1) | (quadrant == 2), -cosine, cosine)


@jax.custom_jvp
def sin_cos(
    y: Float[ArrayLike, "*shape"],
) -> tuple[Float[Array, "*shape"], Float[Array, "*shape"]]:
    """`sin(2 pi y)` and `cos(2 pi y)`, any shape, to 2 ulp on the whole circle.

    The argument is reduced in turns, which loses nothing. XLA calls the scalar libm for
    float64 sines, 1.0 us for a step of one of 64 lanes against 0.09 with this pair.
    """
    return _evaluate(jnp.asarray(y, dtype=float))


@sin_cos.defjvp
def _sin_cos_jvp(
    primals: tuple, tangents: tuple
) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    sine, cosine = sin_cos(primals[0])
    turn = 2 * jnp.pi * tangents[0]
    return (sine, cosine), (cosine * turn, -sine * turn)


def fourier_sum(
    cos: Float[Array, " harmonics"],
    sin: Float[Array, " harmonics"],
    y: Float[ArrayLike, "*shape"],
) -> Float[Array, "*shape"]:
    """`sum_n cos_n cos(2 pi n y) + sin_n sin(2 pi n y)`, n = 1, 2, ...

    `cos`, `sin`: shape (harmonics,); `y`: any shape. Horner's rule in powers of
    `e^(2 pi i y)`, the same ones for the sum and all its derivatives.
    """
    y = jnp.asarray(y, dtype=float)
    turn = _evaluate(jax.lax.stop_gradient(y))
    return _sum_at(cos, sin, _powers(turn, cos.shape[0]), y)


@jax.custom_jvp
def _sum_at(
    cos: Float[Array, " harmonics"],
    sin: Float[Array, " harmonics"],
    powers: list,
    y: Float[Array, "*shape"],
) -> Float[Array, "*shape"]:
    """The sum from `powers` of `e^(2 pi i y)`: `y` itself is there for derivatives."""
    return _add_up(cos, sin, powers)


@partial(jax.jit, inline=True, static_argnums=1)
def _powers(turn: tuple, harmonics: int) -> list[tuple]:
    """z, z^2... of `turn` z, for a group of harmonics or all of them."""
    powers = [turn]
    for n in range(2, min(harmonics, _GROUP) + 1):
        powers.append(_times(powers[n // 2 - 1], powers[n - n // 2 - 1]))
    return powers


@partial(jax.jit, inline=True)
def _add_up(
    cos: Float[Array, " harmonics"], sin: Float[Array, " harmonics"], powers: list
) -> Array:
    if cos.shape[0] <= _BLOCK:
        total = _groups(powers, cos, sin)
    else:
        size = _BLOCK * -(-cos.size // _BLOCK)
        blocks = [jnp.pad(c, (0, size - c.size)).reshape(-1, _BLOCK) for c in (cos, sin)]
        whole = powers[-1]
        for _ in range(int(math.log2(_BLOCK // _GROUP))):
            whole = _times(whole, whole)

        def block(total: tuple, coefficients: list) -> tuple[tuple, None]:
            return _plus(_times(total, whole), _groups(powers, *coefficients)), None

        none = jnp.zeros_like(whole[0]), jnp.zeros_like(whole[0])
        total, _ = jax.lax.scan(block, none, blocks, reverse=True)
    sine, cosine = powers[0]
    return total[1] * cosine - total[0] * sine


def _times(a: tuple, b: tuple) -> tuple:
    """Product of two complex numbers, imaginary part first, as sine and cosine are."""
    return a[0] * b[1] + a[1] * b[0], a[1] * b[1] - a[0] * b[0]


def _plus(a: tuple, b: tuple) -> tuple:
    return a[0] + b[0], a[1] + b[1]


def _groups(
    powers: list[tuple], cos: Float[Array, " harmonics"], sin: Float[Array, " harmonics"]
) -> tuple[Float[Array, "*shape"], Float[Array, "*shape"]]:
    """`sum_n (cos_n - i sin_n) z^(n - 1)`, imaginary part first, from `powers` z, z^2.."""
    total: Any = None
    shape = jnp.shape(powers[0][0])
    for first in reversed(range(0, cos.shape[0], _GROUP)):
        part: Any = tuple(jnp.broadcast_to(v, shape) for v in (-sin[first], cos[first]))
        for n in range(first + 1, min(first + _GROUP, cos.shape[0])):
            (sine, cosine), c, s = powers[n - first - 1], cos[n], sin[n]
            part = (
                part[0] + c * sine - s * cosine,
                part[1] + c * cosine + s * sine,
            )
        total = part if total is None else _plus(_times(total, powers[-1]), part)
    return total


def _sum_at_jvp(primals: tuple, tangents: tuple) -> tuple[Array, Array]:
    cos, sin, powers, y = primals
    cos_dot, sin_dot, _, y_dot = tangents
    total = _sum_at(cos, sin, powers, y)
    change = jnp.zeros_like(total)
    # Zero tangents leave no trace: without this, programs triple with every derivative.
    if not is_zero(y_dot):
        turns = 2 * np.pi * np.arange(1, cos.shape[0] + 1)
        change = _sum_at(turns * sin, -turns * cos, powers, y) * y_dot
    if not (is_zero(cos_dot) and is_zero(sin_dot)):
        # Not by this function: in reverse mode JAX keeps its body alone, where `powers`
        # do not depend on y (derivatives by y of those by coefficients were 0).
        moving = _powers(sin_cos(y), cos.shape[0])
        change = change + _add_up(_filled(cos_dot), _filled(sin_dot), moving)
    return total, change


def _filled(tangent: Any) -> Array:
    return jnp.zeros(tangent.shape) if is_zero(tangent) else tangent


_sum_at.defjvp(_sum_at_jvp, symbolic_zeros=True)
