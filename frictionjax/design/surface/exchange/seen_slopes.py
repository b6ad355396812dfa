"""What upright tips on one root see of a surface: its waves, each times a number."""

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Complex, Float

from ....effects import RigidArray
from ..barrier import basis, basis_at
from .settings import SETTINGS


def shares_seen(array: RigidArray, harmonics: int) -> Complex[np.ndarray, " n"]:
    """`c_n = sum_i weight_i exp(2 pi i n offset_i)`, n from 1; 0 where it is rounding."""
    offsets = np.asarray(array.offsets)
    weights = np.ones(offsets.size) if array.weights is None else np.asarray(array.weights)
    phases = offsets[:, None] * np.arange(1, harmonics + 1)
    # Whole turns go first: large phases would lose digits.
    shares = weights @ np.exp(2j * np.pi * (phases - np.round(phases)))
    return np.where(np.abs(shares) > SETTINGS.unseen * np.sum(weights), shares, 0.0)


def phases_of(shares: Complex[np.ndarray, " n"]) -> Complex[np.ndarray, " n"]:
    """`c_n/|c_n|`, 1 where nothing is seen."""
    unseen = shares == 0
    return np.where(unseen, 1.0, shares) / np.where(unseen, 1.0, np.abs(shares))


def turned(waves: Any, factors: Any) -> np.ndarray:
    """Waves, cosines then sines, each times a complex number."""
    cos, sin = np.split(np.asarray(waves), 2)
    return np.concatenate(times_shares(cos, sin, factors))


def times_shares(cos: Any, sin: Any, shares: Any) -> tuple[Any, Any]:
    """Cosines and sines of waves, each times a complex number; NumPy or traced."""
    found = (cos - 1j * sin) * shares
    return found.real, -found.imag


class SeenSlopes(NamedTuple):
    """Slopes seen, of waves turned so that what is seen of each is `sizes` times it."""

    harmonics: int
    sizes: Float[np.ndarray, " waves"]

    def at(self, y: Any, order: int = 0) -> np.ndarray:
        """Rows that give them, or a derivative, at places `y` in periods, any shape."""
        return basis_at(y, self.harmonics, order) * self.sizes

    def grid(self, rows: int) -> np.ndarray:
        """The same at `rows` places a wave."""
        return basis(self.harmonics, rows * self.harmonics) * self.sizes


def plain_slopes(harmonics: int) -> SeenSlopes:
    """Those of the surface itself."""
    return SeenSlopes(harmonics, np.ones(2 * harmonics))


def bumps(seen: SeenSlopes, waves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places and values of all extrema of the slopes seen.

    Zeros of the derivative, a polynomial in `exp(2 pi i y)`, on the unit circle; those
    beside it do no harm.
    """
    count = seen.harmonics
    cos, sin = np.split(seen.sizes * waves, 2)
    # A wave of v' is 2 pi n times that of v, sqrt(2)/(2 pi n).
    bends = 1j * (cos - 1j * sin)
    zeros = np.roots(np.concatenate([bends[::-1], [0.0], bends.conj()]))
    places = np.angle(zeros) / (2 * np.pi)
    slope, bend = (seen.at(places, order) @ waves for order in (1, 2))
    step = slope / np.where(bend == 0, 1.0, bend)
    near = np.abs(step) < 1 / (SETTINGS.rows_seen * count)
    places = np.where(near, places - step, places)
    return places, seen.at(places) @ waves


def place_of_lowest(waves: Any) -> float:
    """In periods from the highest slope, at most half of one."""
    places, slopes = bumps(plain_slopes(waves.size // 2), np.asarray(waves))
    away = float(places[np.argmin(slopes)] - places[np.argmax(slopes)])
    return abs(away - round(away))


def with_ends_seen(seen: SeenSlopes, waves: np.ndarray, ends: Any) -> np.ndarray:
    """The waves changed until the slopes seen are -M at least and P at most, to rounding.

    `ends`: (P, M). Newton's method on the farthest extrema and all that touch an end or
    are beyond it, by the least change.
    """
    wanted, span = np.array([ends[0], -ends[1]]), np.sum(ends)
    for _ in range(SETTINGS.seen_steps):
        places, slopes = bumps(seen, waves)
        gaps = wanted - slopes[:, None]
        beyond = gaps * [1.0, -1.0]  # < 0: out of the range
        off = np.max(np.abs(np.min(beyond, axis=0)))
        if off <= SETTINGS.ends_seen * span:
            break
        least = np.maximum(np.min(beyond, axis=0), SETTINGS.touching * span)
        where, which = _apart(places, beyond, beyond <= least, seen.harmonics)
        rows = seen.at(places[where])
        waves = waves + np.linalg.pinv(rows, rtol=SETTINGS.rank_seen) @ gaps[where, which]
    return waves


def _apart(
    places: np.ndarray, beyond: np.ndarray, chosen: np.ndarray, harmonics: int
) -> tuple[np.ndarray, np.ndarray]:
    """Of the chosen extrema that are next to each other the farthest out; and its end.

    A flat top is several zeros of the derivative within rounding; to ask for each of them
    is to ask for its tilt too.
    """
    where, which = np.nonzero(chosen)
    kept: list[int] = []
    for index in np.argsort(beyond[where, which]):
        away = places[where[index]] - places[where[kept]]
        if np.all(np.abs(away - np.round(away)) > 1 / (SETTINGS.rows_ratio * harmonics)):
            kept.append(int(index))
    return where[kept], which[kept]
