"""Cells of a load that no bounds are known of: samples, closer where they surprise."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from .._checks import Real, require
from ..intervals import work_of
from .cells import Kind, LoadCells, halves, needle
from .settings import SETTINGS


class Samples:
    """Values and slopes of the function itself, compiled once.

    `cells`: how many are looked at first, fewer of a long program. Raises `ValueError`
    for one that is too long for as many as are needed.
    """

    def __init__(self, fn: Callable[[Real], Real]):
        with jax.ensure_compile_time_eval():
            closed = jax.make_jaxpr(lambda t: jnp.asarray(fn(t), float))(0.5)
        self.numbers = max(1, work_of(closed.jaxpr)[0])
        room = SETTINGS.most_sampled_numbers // (8 * self.numbers)
        known = f"a program of {self.numbers} numbers"
        longest = SETTINGS.most_sampled_numbers // (8 * SETTINGS.fewest)
        allowed = f"at most {longest}, or a PiecewiseLinear load"
        require(room >= SETTINGS.fewest, "load.fn", known, allowed)
        self.cells = min(SETTINGS.sampled, 1 << (room.bit_length() - 1))
        self._chunk = max(64, min(SETTINGS.chunk, SETTINGS.most_at_once // self.numbers))

        @jax.jit
        def rates(times: Any) -> Any:
            one = jnp.ones_like(times)
            return jax.jvp(jax.vmap(lambda t: jnp.asarray(fn(t), float)), (times,), (one,))

        self._rates = rates

    def __call__(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        chunk = self._chunk
        padded = -(-times.size // chunk) * chunk
        whole = np.append(times, np.full(padded - times.size, times[-1:].sum()))
        with jax.ensure_compile_time_eval():
            parts = [self._rates(whole[k : k + chunk]) for k in range(0, padded, chunk)]
        columns = zip(*parts, strict=True)
        value, slope = (np.concatenate(c)[: times.size] for c in columns)
        good = np.isfinite(value)
        if not good.all():
            at = f"no finite number at t = {times[~good][0]:.9g}"
            require(False, "load.fn", at, "finite values on [0, duration]")
        return value, slope


def sampled_cells(at: Samples, duration: float) -> LoadCells:
    """Cells of [0, duration], each foretold by the values and slopes at its ends.

    Cut where they do not foretell what is inside, down to the spacing of floats. Raises
    `ValueError` where that is not affordable, and it still moves otherwise there.
    """
    edges = np.linspace(0.0, duration, at.cells + 1)
    lo, hi, size = edges[:-1], edges[1:], 0.0
    done: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    left = min(
        SETTINGS.most_sampled + at.cells, SETTINGS.most_sampled_numbers // (4 * at.numbers)
    )
    least, most = np.inf, -np.inf
    while lo.size:
        values, slopes = _seen(at, lo, hi)
        if not done:
            _require_slopes(lo, slopes)
        size = max(size, float(np.max(np.abs(values), initial=0.0)))
        least, most = min(least, np.min(values)), max(most, np.max(values))
        kinds = _kinds(values, slopes, hi - lo, size, duration)
        again, left = kinds == Kind.OPEN, left - lo.size
        if 2 * np.sum(again) > left:
            unseen = SETTINGS.unseen * (most - least) + 1e-12 * size
            kinds[again] = _left_open(
                values[:, again], slopes[:, again], lo[again], hi[again], unseen
            )
            again = np.zeros_like(again)
        done.append((lo[~again], hi[~again], kinds[~again]))
        lo, hi = halves(lo[again], hi[again])
    lo, hi, kind = (np.concatenate(column) for column in zip(*done, strict=True))
    order = np.argsort(lo, kind="stable")
    return LoadCells(lo[order], hi[order], kind[order], size)


def _left_open(values, slopes, lo: np.ndarray, hi: np.ndarray, unseen: float) -> np.ndarray:
    """Kinds of cells too many to cut; raises where they may hide more than `unseen`.

    A sine of 1 MHz passed for a load that rests, of which the limit was 0.13 m off.
    """
    off, _ = _surprises(values, slopes * (hi - lo))
    s = np.array(SETTINGS.places)[:, None]
    rise = values[3] - values[0]
    straight = np.max(np.abs(values[0] + rise * s - values[1:3]), axis=0)
    off = np.fmin(off, straight)
    k = int(np.argmax(off))
    often = f"turns more often than once in {hi[k] - lo[k]:.3g} s at t = {lo[k]:.6g}"
    allowed = "turning points few enough to be found: a slower load, a shorter duration"
    require(off[k] <= unseen, "load.fn", often, allowed)
    return np.where(np.abs(rise) > unseen, np.sign(rise).astype(int), int(Kind.SMALL))


def _require_slopes(times: np.ndarray, slopes: np.ndarray) -> None:
    """As 1/cosh far out, where JAX multiplies 0 by infinity."""
    none = np.all(np.isnan(slopes), axis=0)
    if none.any():
        when = f"t = {times[none][0]:.9g}"
        at = f"no finite slope at {when}, where jax.jvp overflows"
        allowed = "a derivative that JAX can take on [0, duration], as that of "
        allowed += "2 exp(-|x|)/(1 + exp(-2 |x|)) for 1/cosh(x)"
        require(False, "load.fn", at, allowed)


def _seen(at: Samples, lo: np.ndarray, hi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Values and slopes at both ends of each cell and at places inside, (4, n)."""
    share = np.array([0.0, *SETTINGS.places, 1.0])[:, None]
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
    off, off_way = _surprises(values, ways)
    largest = np.max(np.abs(ways), axis=0) + size * length / duration
    return (off <= SETTINGS.foretold * size) & (
        off_way <= SETTINGS.foretold_slope * largest
    )


def _surprises(values, ways) -> tuple[np.ndarray, np.ndarray]:
    """How far values inside, and slopes times lengths, are from the cubic of the ends."""
    s = np.array(SETTINGS.places)[:, None]
    rise = values[3] - values[0]
    first, last = ways[0] - rise, ways[3] - rise
    value = values[0] + rise * s + s * (1 - s) * (first * (1 - s) - last * s)
    way = rise + first * (1 - s) * (1 - 3 * s) + last * s * (3 * s - 2)
    off = np.max(np.abs(value - values[1:3]), axis=0)
    return off, np.max(np.abs(way - ways[1:3]), axis=0)
