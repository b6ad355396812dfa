"""Sums of one periodic function's copies, each at a phase of its own, as pieces."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from ..numerics import even_places
from .fitted_pieces import fitted_pieces
from .pieces import Pieces, PiecewiseProfile, piecewise
from .profile_pieces import risen_twice
from .settings import SETTINGS


class TipStates(NamedTuple):
    """A 1-periodic function of the state Y, told at tip coordinates y, arrays (n,).

    `place`: Y, which increases with y, and is y where y has gone on by a period;
    `stretch`: dY/dy. `height`, `slope`, `bend`: the function, and its derivatives in Y.
    """

    place: Float[np.ndarray, " n"]
    stretch: Float[np.ndarray, " n"]
    height: Float[np.ndarray, " n"]
    slope: Float[np.ndarray, " n"]
    bend: Float[np.ndarray, " n"]


AtTips = Callable[[np.ndarray], TipStates]
Derivatives = tuple[np.ndarray, np.ndarray, np.ndarray]


def summed_in_pieces(
    at_tips: AtTips,
    kinks: Float[np.ndarray, " kinks"],
    offsets: Float[np.ndarray, " n"],
    weights: Float[np.ndarray, " n"],
    points: int,
) -> PiecewiseProfile | None:
    """`sum_i weight_i f(Y + offset_i)` as a profile; None where tables have no room.

    `kinks` (tip coordinates in a period): where the third derivative of f jumps. There
    pieces of each copy end. `points`: samples a period that resolve f' in y.
    """
    near = _Inverse(at_tips, kinks)
    own = at_tips(kinks).place % 1.0 if kinks.size else kinks
    offsets, of_each = np.unique(offsets % 1.0, return_inverse=True)
    weights = np.bincount(of_each, weights)
    if offsets.size * max(own.size, SETTINGS.first_pieces) > SETTINGS.rooms[-1]:
        return None
    one = _pieces(near.at_places, own)
    if one is None or not _meets(one, near.at_places):
        return None

    def total(places: np.ndarray) -> Derivatives:
        sums = np.zeros((3, places.size))
        for offset, weight in zip(offsets.tolist(), weights.tolist(), strict=True):
            sums += weight * _values(one, (places + offset) % 1.0)
        return sums[0], sums[1], sums[2]

    found = _pieces(total, ((own[:, None] - offsets) % 1.0).ravel())
    if found is None or not _meets(found, total):
        return None
    # Lanes take so many steps: what resolves f' in y does so where wells are half as wide.
    samples = int(np.ceil(points / min(1.0, 2 * near.narrowest)))
    return piecewise(found, samples, SETTINGS.rooms)


def profile_kinks(profile: PiecewiseProfile) -> Float[np.ndarray, " kinks"]:
    """Where w''' of a profile in pieces jumps, in [0, 1): of splines and corners.

    Taylor polynomials of a series differ by 1e-10 of it where they meet.
    """
    rows = np.asarray(profile.rows)
    rows = rows[np.isfinite(rows[:, 0])]
    left, terms = rows[:, 0], rows[:, 1:]
    length = np.diff(left, append=1.0)
    power = np.arange(3, terms.shape[1])
    thirds = terms[:, 3:] * (power * (power - 1) * (power - 2))
    ending = np.sum(thirds * length[:, None] ** (power - 3), axis=1)
    jumps = np.abs(thirds[:, 0] - np.roll(ending, 1))
    return left[jumps > SETTINGS.jumps * np.max(np.abs(thirds[:, 0]))]


class _Inverse:
    """The tip coordinate of a place, by Newton's method from a table of many."""

    def __init__(self, at_tips: AtTips, kinks: np.ndarray):
        even = np.arange(SETTINGS.pieces) / SETTINGS.pieces
        y = np.union1d(even, kinks)
        found = at_tips(y)
        self._at = at_tips
        self._y = np.concatenate([y - 1, y, y + 1])
        self._places = np.concatenate([found.place + turn for turn in (-1, 0, 1)])
        self.narrowest = float(np.min(found.stretch))

    def at_places(self, places: np.ndarray) -> Derivatives:
        """Height, slope and bend at places in [0, 1], through the tip coordinate."""
        last = self._y.size - 1
        k = np.clip(np.searchsorted(self._places, places, side="right"), 1, last)
        low, high = self._y[k - 1], self._y[k]
        share = (places - self._places[k - 1]) / (self._places[k] - self._places[k - 1])
        y = low + share * (high - low)
        found = self._at(y)
        for _ in range(SETTINGS.newtons):
            off = places - found.place
            if np.max(np.abs(off)) <= SETTINGS.place_rounding:
                break
            y = np.clip(y + off / found.stretch, low, high)
            found = self._at(y)
        return found.height, found.slope, found.bend


def _pieces(at: Callable[[np.ndarray], Derivatives], ends: np.ndarray) -> Pieces | None:
    """Of w by `at`, which tells w, w' and w''; `ends` in [0, 1): where pieces have to."""
    even = np.linspace(0.0, 1.0, SETTINGS.first_pieces + 1)
    edges = _apart(np.sort(ends), even)
    fitting = SETTINGS.degree - 2, SETTINGS.summed, SETTINGS.rooms[-1] - SETTINGS.few
    bends = fitted_pieces(lambda places: at(places)[2], edges, *fitting)
    return None if bends is None else risen_twice(bends, at)


def _apart(ends: np.ndarray, even: np.ndarray) -> np.ndarray:
    """Edges from 0 to 1, of ends a rounding apart one, and even ones that are near none."""
    inside = ends[(ends > SETTINGS.alike_ends) & (ends < 1 - SETTINGS.alike_ends)]
    inside = inside[np.diff(inside, prepend=-1.0) > SETTINGS.alike_ends]
    if not inside.size:
        return even
    k = np.clip(np.searchsorted(inside, even), 1, inside.size) - 1
    beside = np.stack([inside[k], inside[np.minimum(k + 1, inside.size - 1)]])
    far = np.min(np.abs(even - beside), axis=0) > SETTINGS.apart
    return np.unique(np.concatenate([[0.0], even[far], inside, [1.0]]))


def _values(pieces: Pieces, places: np.ndarray) -> np.ndarray:
    """Value, slope and bend (3, n) at places in [0, 1)."""
    k = np.searchsorted(pieces.left, places, side="right") - 1
    t, terms = places - pieces.left[k], pieces.terms[k]
    value, slope, bend = np.zeros((3, places.size))
    for column in terms.T[::-1]:
        bend = bend * t + 2 * slope
        slope = slope * t + value
        value = value * t + column
    return np.stack([value, slope, bend])


def _meets(pieces: Pieces, at: Callable[[np.ndarray], Derivatives]) -> bool:
    """Whether slopes are alike at places that pieces were not made of."""
    places = even_places(SETTINGS.times)
    slopes = at(places)[1]
    off = np.abs(_values(pieces, places)[1] - slopes)
    return bool(np.max(off) <= SETTINGS.summed_alike * np.max(np.abs(slopes)))
