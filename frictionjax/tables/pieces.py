"""Functions in pieces, each a polynomial, found by bins; profiles of them."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float, Int

from .._checks import as_jax, exchanged
from ..profiles import AbstractProfile
from .settings import SETTINGS, size_for


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


def unsampled(profile: AbstractProfile) -> AbstractProfile:
    """The same profile for programs that take no samples of it."""
    if not isinstance(profile, PiecewiseProfile):
        return profile
    return exchanged(profile, {"points": SETTINGS.points_a_period[0]})


def binned(pieces: Pieces, sizes: tuple[int, ...], for_each: int) -> Binned | None:
    """Pieces in a table; None where they are too many, or too short for its bins.

    `for_each`: bins for each piece that there is room for.
    """
    count, terms = pieces.terms.shape
    columns = 1 + (size_for(terms, SETTINGS.terms) or terms)
    for size in sizes:
        bins = for_each * size
        first = np.searchsorted(pieces.left, np.arange(bins) / bins, side="right") - 1
        ends = np.append(first[1:], count - 1)
        if count + SETTINGS.few <= size and np.max(ends - first) <= SETTINGS.few:
            rows = np.zeros((size, columns))
            rows[count:, 0] = np.inf
            rows[:count, 0] = pieces.left
            rows[:count, 1 : 1 + terms] = pieces.terms
            return Binned(as_jax(rows), as_jax(first))
    return None


def piecewise(
    pieces: Pieces, points: int, sizes: tuple[int, ...] = (SETTINGS.pieces,)
) -> PiecewiseProfile | None:
    """Pieces as a profile; None as of `binned`."""
    table = binned(pieces, sizes, SETTINGS.bins)
    samples = size_for(points, SETTINGS.points_a_period) or points
    return None if table is None else PiecewiseProfile(*table, samples)
