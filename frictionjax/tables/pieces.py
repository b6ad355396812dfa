"""A profile in pieces, each a polynomial: splines, polylines."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float, Int

from ..profiles import AbstractProfile
from .settings import SETTINGS, size_for

_DEGREE = 4  # at least: of a corner of a polyline; a spline has 3


class Pieces(NamedTuple):
    """Polynomials `sum_k terms[k] t^k` in `t = y - left` on consecutive pieces of [0, 1).

    `left` (n,): increasing, the first 0. `terms` (n, degree + 1).
    """

    left: Float[np.ndarray, " n"]
    terms: Float[np.ndarray, "n terms"]


class Binned(NamedTuple):
    """Pieces in a table, found by bins.

    `rows` (pieces, 1 + terms): where a piece begins, and its polynomial from there.
    `first` (bins,): the piece that holds the left end of each bin.
    """

    rows: Float[Array, "pieces columns"]
    first: Int[Array, " bins"]

    def __call__(self, y: Float[Array, "*shape"]) -> Float[Array, "*shape"]:
        """Values at places in [0, 1], any shape."""
        count = self.first.shape[0]
        piece = self.first[jnp.clip(jnp.floor(y * count).astype(int), 0, count - 1)]
        for _ in range(SETTINGS.few):
            piece = piece + (y >= self.rows[piece + 1, 0])
        row = self.rows[piece]
        t = y - row[..., 0]
        total = row[..., -1]
        for column in range(row.shape[-1] - 2, 0, -1):
            total = total * t + row[..., column]
        return total


class PiecewiseProfile(AbstractProfile):
    """A 1-periodic profile in pieces, as in `Binned`."""

    rows: Float[Array, "pieces columns"]
    first: Int[Array, " bins"]
    points: int = eqx.field(static=True, default=256)

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        y = jnp.asarray(y)
        return Binned(self.rows, self.first)(y - jnp.floor(y))


def binned(pieces: Pieces, for_each: int = SETTINGS.bins) -> Binned | None:
    """Pieces in a table; None where they are too many, or too short for its bins.

    `for_each`: bins for each piece that there is room for.
    """
    size = size_for(pieces.left.size + SETTINGS.few, SETTINGS.pieces)
    if size is None:
        return None
    bins = for_each * size
    left = np.pad(pieces.left, (0, size - pieces.left.size), constant_values=np.inf)
    first = np.searchsorted(pieces.left, np.arange(bins) / bins, side="right") - 1
    ends = np.append(first[1:], pieces.left.size - 1)
    if np.max(ends - first) > SETTINGS.few:
        return None
    rows = np.zeros((size, 1 + max(1 + _DEGREE, pieces.terms.shape[1])))
    rows[:, 0] = left
    rows[: pieces.left.size, 1 : 1 + pieces.terms.shape[1]] = pieces.terms
    return Binned(jnp.asarray(rows), jnp.asarray(first))


def piecewise(pieces: Pieces, points: int) -> PiecewiseProfile | None:
    """Pieces as a profile; None as of `binned`."""
    table = binned(pieces)
    samples = size_for(points, SETTINGS.points_a_period) or points
    return None if table is None else PiecewiseProfile(*table, samples)
