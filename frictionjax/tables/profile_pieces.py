"""Profiles that are C^2 and no series, as polynomials on pieces."""

from collections.abc import Callable
from typing import Any

import jax
import numpy as np
from jaxtyping import Array, Float

from .._compile import Interpreted, in_chunks
from ..numerics import even_places, slope_of
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

    def bend(places: np.ndarray) -> np.ndarray:
        return _at(profile, places)[2]

    pieces = _with_kinks(bend)
    if pieces is None:
        return None
    height, slope, _ = _at(profile, pieces.left)
    power = np.arange(2, SETTINGS.degree + 1)
    terms = pieces.terms / (power * (power - 1))
    found = Pieces(pieces.left, np.column_stack([height, slope, terms]))
    table = piecewise(found, profile.points)
    return table if table is not None and _say_the_same(profile, table) else None


def _say_the_same(profile: AbstractProfile, table: AbstractProfile) -> bool:
    """Whether they do, in w, w' and w'', at places that pieces were not made of.

    At as many as the profile is sampled at, as a bump between few is seen by none.
    """
    places = even_places(max(SETTINGS.times, profile.points))
    pairs = zip(_at(profile, places), _at(table, places), SETTINGS.alike, strict=True)
    return all(
        bool(np.max(np.abs(one - other)) <= allowed * np.max(np.abs(one)))
        for one, other, allowed in pairs
    )


def _with_kinks(fn: Callable[[np.ndarray], np.ndarray]) -> Pieces | None:
    """Pieces of w'' that end at its kinks, which show as ever shorter pieces."""
    fitting = SETTINGS.degree - 2, SETTINGS.bent
    pieces = fitted_pieces(fn, np.array([0.0, 1.0]), *fitting)
    if pieces is None:
        return None
    kinks = _shortest(np.append(pieces.left, 1.0))
    if kinks.size:
        pieces = fitted_pieces(fn, np.array([0.0, *kinks, 1.0]), *fitting)
    return pieces


def _shortest(edges: Float[np.ndarray, " n"]) -> Float[np.ndarray, " m"]:
    """The middle of the shortest piece of each run of pieces that no bin could find."""
    width = np.diff(edges)
    short = width * SETTINGS.bins * SETTINGS.pieces < 0.5
    change = np.diff(short.astype(int), prepend=0, append=0)
    begins, ends = np.flatnonzero(change > 0), np.flatnonzero(change < 0)
    places = [a + int(np.argmin(width[a:b])) for a, b in zip(begins, ends, strict=True)]
    return edges[places] + 0.5 * width[places]
