"""Where the path is steep, and whether a few nodes would see it.

A load, or a support, may move the path fast within a stretch that is far shorter than what
is between two nodes of a survey; its speed tells nothing of that elsewhere, its way does.
"""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from ..._checks import Real
from ..._compile import in_chunks, once_a_scene
from ...loads import AbstractPull
from ...supports import AbstractSupport
from .motion import state_on_path
from .path import Path
from .sampled_slide import nodes_of, through_nodes
from .settings import SETTINGS


@once_a_scene
def _zoomed(
    load: AbstractPull,
    support: AbstractSupport,
    rows: Float[Array, "room 7"],
    low: Float[Array, " n"],
    high: Float[Array, " n"],
) -> tuple[Float[Array, "n times"]]:
    """Times closer and closer to the steepest place of each interval, on both sides."""
    states = jax.vmap(lambda time: state_on_path(load, support, rows, time)[0])

    def zoom(ends: Array, _: None) -> tuple[Array, Array]:
        share = jnp.arange(SETTINGS.parts + 1) / SETTINGS.parts
        inner = ends[0] + (ends[1] - ends[0]) * share
        part = jnp.argmax(jnp.abs(jnp.diff(states(inner))))
        ends = jax.lax.dynamic_slice_in_dim(inner, part, 2)
        return ends, ends

    def closer(low: Real, high: Real) -> Array:
        ends, found = jax.lax.scan(zoom, jnp.stack([low, high]), length=SETTINGS.zooms)
        return jnp.append(found, 0.5 * (ends[0] + ends[1]))

    return (jax.vmap(closer)(low, high),)


def probes_of(
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
    both = path.motion_at(np.append(edges, middles))
    ways = np.diff(both.states[: edges.size].reshape(edges.shape))
    speeds = both.speeds[edges.size :].reshape(middles.shape)
    gaps = np.abs(ways - speeds * np.diff(edges))
    large = gaps > SETTINGS.gap * np.max(np.abs(ways), axis=1, keepdims=True)
    wanted = np.max(np.count_nonzero(large, axis=1), initial=0)
    count = int(
        np.clip(wanted, SETTINGS.suspects * samples, SETTINGS.most_suspects * samples)
    )
    suspects = np.argpartition(-gaps, count, axis=1)[:, :count]
    columns = [np.take_along_axis(edges, suspects + k, 1).ravel() for k in (0, 1)]
    parts = path.load, path.support, path.rows
    (closer,) = in_chunks(_zoomed, SETTINGS.zoomed, parts, tuple(columns))
    found = [middles, closer.reshape(low.size, -1)]
    known = getattr(path.load, "steepest", None)
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
