"""Cells of a load that no bounds are known of: samples, closer where they surprise."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ..arguments import Real, require
from .cells import Cells, Kind, Point, halves, needle

# Cells of which each is looked at from its ends and at two places inside. A pulse that
# lasts longer than one is seen; of shorter ones, one in the share of its cell.
CELLS = 2**16
_CHUNK = 2**14  # times of one compiled call
_MOST = 2**20  # cells
_PLACES = (0.38, 0.71)  # inside a cell: not where multiples of T/2^n are
# How well a cubic through the ends foretells values inside, of max |l|, and slopes, of the
# largest there and of the mean one. (By values alone kinks passed in cells that are short.)
_FORETOLD, _FORETOLD_SLOPE = 1e-7, 1e-5


def by_samples(fn: Callable[[Real], Real]) -> Point:
    """Values and slopes of the function itself, compiled once."""

    @jax.jit
    def rates(times: Any) -> Any:
        one = jnp.ones_like(times)
        return jax.jvp(jax.vmap(lambda t: jnp.asarray(fn(t), float)), (times,), (one,))

    def at(times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        padded = -(-times.size // _CHUNK) * _CHUNK
        whole = np.append(times, np.full(padded - times.size, times[-1:].sum()))
        with jax.ensure_compile_time_eval():
            parts = [rates(whole[k : k + _CHUNK]) for k in range(0, padded, _CHUNK)]
        columns = zip(*parts, strict=True)
        value, slope = (np.concatenate(c)[: times.size] for c in columns)
        good = np.isfinite(value)
        if not good.all():
            at = f"no finite number at t = {times[~good][0]:.9g}"
            require(False, "load.fn", at, "finite values on [0, duration]")
        return value, slope

    return at


def sampled_cells(at: Point, lo: np.ndarray, hi: np.ndarray, duration: float) -> Cells:
    """Cells in [lo, hi] (n,), each foretold by the values and slopes at its ends.

    Cut where they do not foretell what is inside, down to the spacing of floats.
    """
    size, seen, done = 0.0, 0, []
    while lo.size:
        values, slopes = _seen(at, lo, hi)
        if not seen:
            _require_slopes(lo, slopes)
        size = max(size, float(np.max(np.abs(values), initial=0.0)))
        kinds = _kinds(values, slopes, hi - lo, size, duration)
        again, seen = kinds == Kind.OPEN, seen + lo.size
        if seen > _MOST + CELLS:
            kinds, again = np.where(again, Kind.SMALL, kinds), np.zeros_like(again)
        done.append((lo[~again], hi[~again], kinds[~again]))
        lo, hi = halves(lo[again], hi[again])
    lo, hi, kind = (np.concatenate(column) for column in zip(*done, strict=True))
    order = np.argsort(lo, kind="stable")
    return Cells(lo[order], hi[order], kind[order], size)


def _require_slopes(times: np.ndarray, slopes: np.ndarray) -> None:
    """As 1/cosh far out, where JAX multiplies 0 by infinity."""
    none = np.all(np.isnan(slopes), axis=0)
    if none.any():
        at = f"no finite slope at t = {times[none][0]:.9g}"
        require(False, "load.fn", at, "a derivative that JAX can take on [0, duration]")


def _seen(at: Point, lo: np.ndarray, hi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Values and slopes at both ends of each cell and at places inside, (4, n)."""
    share = np.array([0.0, *_PLACES, 1.0])[:, None]
    times = lo + (hi - lo) * share
    values, slopes = at(times.ravel())
    return values.reshape(times.shape), slopes.reshape(times.shape)


def _kinds(values, slopes, length: np.ndarray, size: float, duration: float) -> np.ndarray:
    ways = slopes * length
    up, down = np.all(ways >= 0, axis=0), np.all(ways <= 0, axis=0)
    turns = np.sum(np.sign(ways[1:]) != np.sign(ways[:-1]), axis=0)
    small = np.max(np.abs(values - values[0]), axis=0) <= 1e-15 * size
    rules = (
        (up & down, Kind.FLAT),
        (up, Kind.RISING),
        (down, Kind.FALLING),
        (turns == 1, Kind.BENT),
        (small, Kind.SMALL),
    )
    kinds = np.select([rule for rule, _ in rules], [k for _, k in rules], Kind.OPEN)
    kinds = np.where(_is_foretold(values, ways, length, size, duration), kinds, Kind.OPEN)
    short = (kinds == Kind.OPEN) & (length <= needle(duration))
    return np.where(short, Kind.NEEDLE, kinds)


def _is_foretold(values, ways, length: np.ndarray, size: float, duration: float):
    """Whether the cubic through the ends of each cell is near what is inside."""
    s = np.array(_PLACES)[:, None]
    rise = values[3] - values[0]
    first, last = ways[0] - rise, ways[3] - rise
    value = values[0] + rise * s + s * (1 - s) * (first * (1 - s) - last * s)
    way = rise + first * (1 - s) * (1 - 3 * s) + last * s * (3 * s - 2)
    off = np.max(np.abs(value - values[1:3]), axis=0)
    off_way = np.max(np.abs(way - ways[1:3]), axis=0)
    largest = np.max(np.abs(ways), axis=0) + size * length / duration
    return (off <= _FORETOLD * size) & (off_way <= _FORETOLD_SLOPE * largest)
