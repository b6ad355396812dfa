"""Profiles that are C^2 and no series, as polynomials on pieces."""

from collections.abc import Callable
from typing import Any

import jax
import numpy as np
from jaxtyping import Array, Float
from numpy.polynomial import Polynomial

from .._compile import Interpreted, in_chunks
from ..numerics import are_near, even_places, slope_of
from ..profiles import AbstractProfile
from .fitted_pieces import fitted_pieces
from .pieces import Pieces, PiecewiseProfile, piecewise
from .settings import SETTINGS


@Interpreted
def _derivatives(profile: AbstractProfile, places: Array) -> tuple[Array, Array, Array]:
    slope = slope_of(profile)
    at_one = profile, slope, slope_of(slope)
    height, steepness, bend = (jax.vmap(fn)(places) for fn in at_one)
    return height, steepness, bend


def _at(profile: AbstractProfile, places: np.ndarray) -> Any:
    return in_chunks(_derivatives, SETTINGS.times, (profile,), (places,))


def profile_in_pieces(profile: AbstractProfile) -> PiecewiseProfile | None:
    """A known profile in pieces; None where tables have no room for what meets it.

    Polynomials meet w'', and w and w' where they begin: those that meet w alone are off in
    w'' by 1e-15 over the square of their length, and so is where friction has its folds.
    """

    def at(places: np.ndarray) -> Any:
        return _at(profile, places)

    bends = _with_kinks(lambda places: at(places)[2])
    if bends is None:
        return None
    found = risen_twice(bends, at)
    table = piecewise(found, profile.points)
    return table if table is not None and _say_the_same(profile, table) else None


def risen_twice(bends: Pieces, at: Callable[[np.ndarray], Any]) -> Pieces:
    """Pieces of w from those of w'', by `at(places)`: w and w' where they begin."""
    height, slope, *_ = at(bends.left)
    power = np.arange(2, bends.terms.shape[1] + 2)
    terms = bends.terms / (power * (power - 1))
    return Pieces(bends.left, np.column_stack([height, slope, terms]))


def _say_the_same(profile: AbstractProfile, table: AbstractProfile) -> bool:
    """Whether they do, in w, w' and w'', at places that pieces were not made of.

    At as many as the profile is sampled at, as a bump between few is seen by none.
    """
    places = even_places(max(SETTINGS.times, profile.points))
    pairs = zip(_at(profile, places), _at(table, places), SETTINGS.alike, strict=True)
    return all(are_near(*pair) for pair in pairs)


def _with_kinks(fn: Callable[[np.ndarray], np.ndarray]) -> Pieces | None:
    """Pieces of w'' that end at its kinks, which show as ever shorter pieces."""
    fitting = SETTINGS.degree - 2, SETTINGS.bent
    even = np.linspace(0.0, 1.0, SETTINGS.first_pieces + 1)
    pieces = fitted_pieces(fn, even, *fitting)
    if pieces is None:
        return None
    kinks = _kinks_of(pieces)
    if not kinks.size:
        return pieces
    inside = even[1:-1]
    apart = np.min(np.abs(inside[:, None] - kinks), axis=1) > SETTINGS.apart
    return fitted_pieces(fn, np.unique([0.0, *inside[apart], *kinks, 1.0]), *fitting)


def _kinks_of(pieces: Pieces) -> Float[np.ndarray, " n"]:
    """Where pieces on both sides of a run of them that no bin could find meet.

    The middle of the shortest one is 1e-9 off, as a piece is met when it begins a rounding
    before a kink: of functions with six kinks a third had no table.
    """
    edges = np.append(pieces.left, 1.0)
    short = np.diff(edges) * SETTINGS.bins * SETTINGS.pieces < 0.5
    change = np.diff(short.astype(int), prepend=0, append=0)
    begins, ends = np.flatnonzero(change > 0), np.flatnonzero(change < 0)
    runs = zip(begins.tolist(), ends.tolist(), strict=True)
    return np.array([_met_between(pieces, edges, *run) for run in runs])


def _met_between(
    pieces: Pieces, edges: Float[np.ndarray, " n"], begin: int, end: int
) -> float:
    width = np.diff(edges[begin : end + 1])
    shortest = begin + int(np.argmin(width))
    place = 0.5 * (edges[shortest] + edges[shortest + 1])
    if begin == 0 or end == pieces.left.size:  # at the seam: nothing on one side
        return place
    before, after = (
        Polynomial(pieces.terms[k])(Polynomial([place - pieces.left[k], 1.0]))
        for k in (begin - 1, end)
    )
    apart, way = before - after, 0.0
    for _ in range(SETTINGS.newton):
        slope = apart.deriv()(way)
        way -= apart(way) / slope if slope else 0.0
    return place + way if edges[begin] <= place + way <= edges[end] else place
