"""The unknowns of a fit and the linear rows between which they stay."""

import math
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .settings import SETTINGS


class Unknowns(NamedTuple):
    """A point of the fit, in units of the slope and the bending energy expected.

    `waves`: of `v = w'`, first cosines then sines, scaled so that their squares add up to
    `int v'^2`. `plus` = (low, high) with `v(0) > low` and `v < high` everywhere, so that
    max v is known from both sides; `minus` the same of -v, `low` at the place of the start.
    `heights`: above the highest point of w and below the lowest, where they are bounded.
    `free`: bristle parameters in shares of their bounds.
    """

    waves: Float[Array, " waves"]
    plus: Float[Array, "2"]
    minus: Float[Array, "2"]
    heights: Float[Array, " heights"]
    free: Float[Array, " free"]


class FitShape(NamedTuple):
    """Sizes of the unknowns and which bounds there are: what a program is compiled for."""

    harmonics: int
    sharp: bool
    high: bool
    free: int

    @property
    def points(self) -> int:
        """Rows over a period."""
        return SETTINGS.rows * self.harmonics

    def split(self, x: Float[Array, " n"]) -> Unknowns:
        """A flat vector by name."""
        first = 2 * self.harmonics
        last = first + 4 + 2 * self.high
        plus, minus = x[first : first + 2], x[first + 2 : first + 4]
        return Unknowns(x[:first], plus, minus, x[first + 4 : last], x[last:])

    def rows(self) -> np.ndarray:
        """`G` of the rows `G x <= ends`; see `ends`."""
        slopes, curvatures, heights = (
            basis(self.harmonics, self.points, k) for k in ORDERS
        )
        blocks = [(slopes, _unit(4, 1)), (-slopes, _unit(4, 3))]
        if self.sharp:
            blocks += [(curvatures, np.zeros(4)), (-curvatures, np.zeros(4))]
        more = 2 * self.high
        rows = [_block(waves, reach, np.zeros(more)) for waves, reach in blocks]
        if self.high:
            rows += [_block(heights, np.zeros(4), _unit(2, 0))]
            rows += [_block(-heights, np.zeros(4), _unit(2, 1))]
            rows += [np.append(np.zeros(2 * self.harmonics + 4), [1.0, 1.0])[None]]
        stacked = np.concatenate(rows)
        count, own = stacked.shape
        shares = np.eye(self.free)
        shares = np.concatenate([-shares, shares])
        left = np.concatenate([stacked, np.zeros((count, self.free))], axis=1)
        right = np.concatenate([np.zeros((2 * self.free, own)), shares], axis=1)
        return np.concatenate([left, right])

    def ends(self, curvature: Array, height: Array) -> Float[Array, " rows"]:
        """Right-hand sides: `curvature` and `height` are the largest allowed, scaled."""
        count = self.points
        ends = [jnp.zeros(2 * count)]
        if self.sharp:
            ends += [jnp.full(2 * count, SETTINGS.row_margin * curvature)]
        if self.high:
            ends += [jnp.zeros(2 * count), SETTINGS.row_margin * jnp.atleast_1d(height)]
        ends += [jnp.zeros(self.free), jnp.ones(self.free)]
        return jnp.concatenate(ends)


ORDERS = (0, 1, -1)  # derivatives of v: slopes, curvatures, heights


def basis(harmonics: int, points: int, order: int = 0) -> np.ndarray:
    """The derivative of `v` of this order at `points` places of a period, by `waves`."""
    return basis_at(np.arange(points) / points, harmonics, order)


def basis_at(y: Any, harmonics: int, order: int = 0) -> np.ndarray:
    """The same at places `y` in periods, any shape."""
    return np.asarray(_basis(np.asarray(y), harmonics, order, np))


def _basis(y, harmonics: int, order: int, xp):
    turns = 2 * np.pi * np.arange(1, harmonics + 1).reshape((1,) * y.ndim + (-1,))
    phase = turns * y[..., None] + 0.5 * np.pi * order
    size = math.sqrt(2.0) * turns ** (order - 1.0)
    return xp.concatenate([size * xp.cos(phase), size * xp.sin(phase)], axis=-1)


def at(waves: Array, y: Array, order: int = 0) -> Array:
    """A derivative of `v` at the places `y`, any shape."""
    return _basis(y, waves.shape[-1] // 2, order, jnp) @ waves


def derivatives(waves: Array) -> Array:
    """Waves of v, v' and w: the orders of `ORDERS`, shape (3, waves)."""
    count = waves.shape[-1] // 2
    turns = 2 * jnp.pi * jnp.arange(1, count + 1)
    c, s = waves[:count], waves[count:]
    bend = jnp.concatenate([turns * s, -turns * c])
    height = jnp.concatenate([-s / turns, c / turns])
    return jnp.stack([waves, bend, height])


def heights_of_waves(waves: Array) -> tuple[Array, Array]:
    """`cos` and `sin` of the heights `w`, as a `Fourier` profile takes them."""
    count = waves.shape[-1] // 2
    turns: Any = 2 * np.pi * np.arange(1, count + 1)
    size = (math.sqrt(2.0) / turns**2)[(None,) * (waves.ndim - 1)]
    return -size * waves[..., count:], size * waves[..., :count]


def waves_of_heights(cos: Array, sin: Array) -> Array:
    """The waves of a profile: `heights_of_waves` turned round."""
    turns = 2 * np.pi * np.arange(1, cos.shape[-1] + 1)
    size = turns**2 / math.sqrt(2.0)
    return jnp.concatenate([size * jnp.asarray(sin), -size * jnp.asarray(cos)], axis=-1)


def _unit(size: int, index: int) -> np.ndarray:
    return -np.eye(size)[index]


def _block(waves: np.ndarray, reach: np.ndarray, heights: np.ndarray) -> np.ndarray:
    rest = np.concatenate([reach, heights])
    return np.concatenate([waves, np.tile(rest, (waves.shape[0], 1))], axis=1)


def flat(point: Unknowns) -> Float[Array, " n"]:
    """The vector that `FitShape.split` takes apart."""
    return jnp.concatenate(jax.tree_util.tree_leaves(point))
