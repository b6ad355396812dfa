"""Other surfaces of which upright tips on one root see the same extreme slopes."""

from typing import Any

import numpy as np

from ...effects import RigidArray
from ...profiles import Fourier
from .barrier import heights_of_waves, waves_of_heights
from .exchange import SETTINGS as EXCHANGE_SETTINGS
from .exchange import SeenSlopes, bumps, phases_of, shares_seen, turned, with_ends_seen
from .settings import SETTINGS


def surfaces_seen_alike(
    array: RigidArray, profile: Fourier, count: int, size: float, seed: int
) -> list[Fourier]:
    """As `members`, of `count` draws those that keep both extreme slopes.

    `size`: square root of the bending energy of what is added over that of the profile.
    """
    waves = np.asarray(waves_of_heights(profile.cos, profile.sin))
    shares = shares_seen(array, waves.size // 2)
    seen = SeenSlopes(shares.size, np.tile(np.abs(shares), 2))
    own = turned(waves, phases_of(shares))
    places, slopes = bumps(seen, own)
    ends = np.array([np.max(slopes), -np.min(slopes)])
    off = np.minimum(np.abs(slopes - ends[0]), np.abs(slopes + ends[1]))
    touching = seen.at(places[off <= EXCHANGE_SETTINGS.touching * np.sum(ends)])
    span = np.linalg.qr(touching.T)[0]
    draw, decay = np.random.default_rng(seed), np.tile(np.arange(1, shares.size + 1), 2)
    found = []
    for _ in range(count):
        way = draw.standard_normal(own.size) / decay
        way = way - span @ (span.T @ way)
        way *= size * np.linalg.norm(own) / np.linalg.norm(way)
        found.append(_nearest_alike(seen, own, way, ends))
    turns = phases_of(shares).conj()
    rows: list[Any] = [turned(one, turns) for one in found if one is not None]
    return [Fourier(*heights_of_waves(row)) for row in rows]


def _nearest_alike(
    seen: SeenSlopes, own: np.ndarray, way: np.ndarray, ends: np.ndarray
) -> np.ndarray | None:
    """The first of some steps along a way, each half the last, that keeps both ends."""
    for halving in range(SETTINGS.halvings):
        waves = with_ends_seen(seen, own + 0.5**halving * way, ends)
        slopes = bumps(seen, waves)[1]
        reached = np.array([np.max(slopes), -np.min(slopes)])
        if np.sum(np.abs(reached - ends)) <= SETTINGS.exact * np.sum(ends):
            return waves
    return None
