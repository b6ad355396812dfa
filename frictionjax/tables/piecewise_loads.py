"""Loads given as functions, as polynomials on pieces."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from .._checks import Real
from .._compile import in_chunks, values_at
from ..loads import AbstractPull, PiecewiseLinear
from ..numerics import are_near, even_places
from .fitted_pieces import fitted_pieces
from .loads import SumOfLoads, load_table
from .pieces import Binned, binned
from .settings import SETTINGS


class PiecewiseLoad(AbstractPull):
    """A function on [0, duration] (s) in pieces, as in `Binned`, at shares of it.

    `steepest`: where it is known to be, s; NaN where it is not.
    """

    rows: Float[Array, "pieces columns"]
    first: Int[Array, " bins"]
    duration: Real
    steepest: Real

    def __call__(self, t: Real) -> Real:
        return Binned(self.rows, self.first)(t / self.duration)


def load_in_pieces(
    load: AbstractPull, turning_points: Float[np.ndarray, " n"], duration: float
) -> AbstractPull:
    """The table of a known load; a function in pieces, itself where none meet it.

    `turning_points`: those inside (0, duration), and kinks, in s: there pieces end.
    """
    table = load_table(load)
    if isinstance(table, SumOfLoads | PiecewiseLinear):
        return table

    def values(places: np.ndarray) -> np.ndarray:
        return in_chunks(values_at, SETTINGS.times, (table,), (duration * places,))

    known = getattr(table, "steepest", None)
    steepest = float("nan" if known is None else known)
    inside = [steepest] if 0 < steepest < duration else []
    edges = np.unique([0.0, *turning_points, *inside, duration]) / duration
    pieces, room = fitted_pieces(values, edges), SETTINGS.load_pieces
    found = pieces and binned(pieces, room, SETTINGS.function_bins)
    if found is None:
        return table
    load = PiecewiseLoad(*found, jnp.asarray(duration), jnp.asarray(steepest))
    return load if _say_the_same(table, load, duration) else table


def _say_the_same(load: AbstractPull, pieces: AbstractPull, duration: float) -> bool:
    """Whether they do at times that pieces were not made of, all over the duration."""
    times = duration * even_places(SETTINGS.times)
    return are_near(values_at(load, times), values_at(pieces, times), SETTINGS.same)
