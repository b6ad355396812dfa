"""Where the path is steep, and whether a few nodes would see it.

A load, or a support, may move the path fast within a stretch that is far shorter than what
is between two nodes of a survey; its speed tells nothing of that elsewhere, its way does.
"""

import numpy as np
from jaxtyping import Bool, Float

from ...model import TabulatedScene
from .path import Path, speeds_at, states_at
from .sampled_slide import nodes_of, through_nodes
from .settings import SETTINGS


def _zoomed(
    scene: TabulatedScene, path: Path, low: np.ndarray, high: np.ndarray
) -> np.ndarray:
    """Times closer and closer to the steepest place of each interval, on both sides."""
    share, found = np.arange(SETTINGS.parts + 1) / SETTINGS.parts, []
    for _ in range(SETTINGS.zooms):
        inner = low[..., None] + (high - low)[..., None] * share
        rises = np.abs(np.diff(_states(scene, path, inner)))
        part = np.argmax(rises, axis=-1)[..., None]
        low, high = (np.take_along_axis(inner, part + k, axis=-1)[..., 0] for k in (0, 1))
        found += [low, high]
    return np.concatenate([*found, 0.5 * (low + high)], axis=-1)


def _states(scene: TabulatedScene, path: Path, times: np.ndarray) -> np.ndarray:
    return states_at(scene, path, times.ravel()).reshape(times.shape)


def probes_of(
    scene: TabulatedScene,
    path: Path,
    low: Float[np.ndarray, " n"],
    high: Float[np.ndarray, " n"],
    samples: int = SETTINGS.samples,
) -> Float[np.ndarray, "n m"]:
    """Times in [low, high] (n,) in s, (n, m), at which the path's speed tells the most.

    Evenly spaced ones, and where the path moves otherwise than its speed there says: a ramp
    between two samples shows in the way. A ramp that lasts a 1e-8 of [low, high] is found
    where it moves the path by more than the bend of the rest.
    """
    edges = low[:, None] + (high - low)[:, None] * np.arange(samples + 1) / samples
    middles = 0.5 * (edges[:, 1:] + edges[:, :-1])
    ways = np.diff(_states(scene, path, edges))
    gaps = np.abs(ways - speeds_at(scene, path, middles) * np.diff(edges))
    large = gaps > SETTINGS.gap * np.max(np.abs(ways), axis=1, keepdims=True)
    wanted = np.max(np.count_nonzero(large, axis=1), initial=0)
    count = int(
        np.clip(wanted, SETTINGS.suspects * samples, SETTINGS.most_suspects * samples)
    )
    suspects = np.argpartition(-gaps, count, axis=1)[:, :count]
    early, late = (np.take_along_axis(edges, suspects + k, axis=1) for k in (0, 1))
    found = [middles, _zoomed(scene, path, early, late)]
    known = getattr(scene.load, "steepest", None)
    if known is not None:
        times = np.full((low.size, 1), float(known))
        inside = (times > low[:, None]) & (times < high[:, None])
        found.append(np.where(inside, times, middles[:, :1]))
    return np.concatenate(found, axis=1)


def nodes_inside(
    low: Float[np.ndarray, " n"], high: Float[np.ndarray, " n"]
) -> Float[np.ndarray, "n nodes"]:
    """Nodes of [low, high] (n,) in s, (n, nodes): at the ends from inside, where slides
    begin and pieces meet."""
    share = np.clip(
        nodes_of(0.0, 1.0, SETTINGS.nodes), SETTINGS.inside, 1 - SETTINGS.inside
    )
    times = low[:, None] + (high - low)[:, None] * share
    after, before = np.nextafter(low, high), np.nextafter(high, low)
    return np.clip(times, after[:, None], before[:, None])


def strictly_between(
    low: Float[np.ndarray, " n"],
    high: Float[np.ndarray, " n"],
    times: Float[np.ndarray, "n m"],
) -> Bool[np.ndarray, "n m"]:
    """Which times (n, m) are inside: at the ends the path rests still, or has the speed of
    the next piece."""
    return (times > low[:, None]) & (times < high[:, None])


def unseen_of(
    low: Float[np.ndarray, " n"],
    high: Float[np.ndarray, " n"],
    known: Float[np.ndarray, "n nodes"],
    times: Float[np.ndarray, "n m"],
    speeds: Float[np.ndarray, "n m"],
) -> Float[np.ndarray, " n"]:
    """By how much a polynomial through `known` (n, nodes) misses speeds (n, m), at most.

    Of the speed there; only times between `low` and `high` (n,) count.
    """
    inside = strictly_between(low, high, times)
    long = np.where(high > low, high, low + 1.0)
    gaps = np.abs(through_nodes(low, long, known, times) - speeds) * inside
    # Of the largest speed, the slide beside a short burst would count for nothing.
    typical = SETTINGS.typical * np.median(np.abs(known), axis=1)[:, None]
    size = np.maximum(np.maximum(np.abs(speeds), typical), 1e-300)
    return np.max(gaps / size, axis=1)
