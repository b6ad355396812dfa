"""Where a free number is admissible, and all turns of a quantity over it."""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from ..._checks import Real
from ...bristles import AbstractBristle
from ...numerics import find_root, slope_of
from ..common import FreeParameter, OnSlopes, Slopes, on_slopes, quantity_of, side_of
from .settings import SETTINGS


class Admissible(NamedTuple):
    """Intervals of admissible coordinates and the quantity at nodes that hold its turns.

    `nodes`, `values`: (PIECES, N), sorted in each interval, NaN in empty ones; `turns`
    where a node is an extremum inside. `low`, `high` (PIECES,): least and largest value,
    infinite at poles. `flat`: the quantity is the same in the whole interval. `side`
    (PIECES,): sign of alpha there. `missed`: more intervals, or turns, than there is room
    for.
    """

    nodes: Float[Array, "pieces n"]
    values: Float[Array, "pieces n"]
    turns: Bool[Array, "pieces n"]
    low: Float[Array, " pieces"]
    high: Float[Array, " pieces"]
    flat: Bool[Array, " pieces"]
    side: Float[Array, " pieces"]
    missed: Bool[Array, ""]

    @property
    def ends(self) -> Float[Array, "pieces 2"]:
        """Admissible intervals of the coordinate."""
        return jnp.stack([self.nodes[:, 0], self.nodes[:, -1]], axis=1)


def survey(
    free: FreeParameter,
    bristle: AbstractBristle,
    slopes: Slopes,
    which: Real,
    low: Real,
    high: Real,
    pulling: Bool[Array, ""],
) -> tuple[Admissible, Admissible]:
    """Look over the coordinates between `low` and `high`; traceable, not differentiable.

    Where the bristle presses, or pulls and `pulling` allows it, and where it pulls and may
    not. One grid for both, so the second costs its nodes only.
    """

    @jax.jit  # traced once
    def law(x: Real) -> tuple[Real, Real, OnSlopes]:
        part = free.at(bristle, x)
        found = on_slopes(part, slopes)
        return quantity_of(found, which), side_of(part, found), found

    now = free.coordinate(bristle, free.now(bristle))
    ends, sides, missed = _pieces(law, low, high, now, pulling)
    found = scan_admissible(lambda x: law(x)[0], ends, sides)
    most = SETTINGS.most_intervals
    halves = slice(most), slice(most, 2 * most)
    half = [jax.tree_util.tree_map(lambda row, i=i: row[i], found) for i in halves]
    allowed, others = (
        part._replace(missed=jnp.any(part.missed) | more)
        for part, more in zip(half, missed, strict=True)
    )
    return allowed, others


def _pieces(
    law: Callable, low: Real, high: Real, now: Real, pulling: Bool[Array, ""]
) -> tuple[Array, Array, list]:
    """Ends (2 PIECES, 2) of the intervals where `side` is one sign, and those signs.

    First those that are allowed, then those that pull and are not; whether some miss.
    """
    grid = low + (high - low) * jnp.arange(SETTINGS.grid) / (SETTINGS.grid - 1)
    grid = grid.at[-1].set(high)
    now = jnp.where(jnp.isfinite(now), jnp.clip(now, low, high), low)
    nodes = jnp.sort(jnp.concatenate([grid, _narrow(law, grid), now[None]]))

    def side(x: Array) -> Array:
        return jax.vmap(law)(x)[1]

    sides = side(nodes)
    before = jnp.concatenate([jnp.zeros(1), sides[:-1]])
    after = jnp.concatenate([sides[1:], jnp.zeros(1)])
    opens, closes = (sides != 0) & (sides != before), (sides != 0) & (sides != after)
    wanted = (sides > 0) | pulling, (sides < 0) & ~pulling
    most = SETTINGS.most_intervals
    first = jnp.concatenate([first_places(opens & some, most) for some in wanted])
    last = jnp.concatenate([first_places(closes & some, most) for some in wanted])
    neighbours = jnp.concatenate([first - 1, last + 1])
    beyond = nodes[jnp.clip(neighbours, 0, nodes.shape[0] - 1)]
    inside = nodes[jnp.concatenate([first, last])]
    edges = _edges(side, inside, beyond).reshape(2, 2 * most).T
    there = first >= 0
    missed = [jnp.sum(opens & some) > most for some in wanted]
    return (
        jnp.where(there[:, None], edges, jnp.nan),
        jnp.where(there, sides[first], 0.0),
        missed,
    )


def _narrow(law: Callable, grid: Float[Array, " n"]) -> Float[Array, " few"]:
    """Where intervals between two samples may be: alpha nearest to 0, largest margins.

    Local maxima below 0, the highest two of each, by ternary search: no slope is asked
    for. Where there is none, a place that does no harm.
    """

    def pressing(x: Array) -> OnSlopes:
        return jax.vmap(jax.vmap(law))(x)[2]

    def deficits(x: Array, side: Array) -> Array:
        """alpha, turned so that it rises to 0, and the margin, at places in two columns."""
        found = pressing(x)
        both = jnp.stack([-side * found.alpha[:, 0], found.margin[:, 1]], axis=1)
        return jnp.nan_to_num(both, nan=-jnp.inf)

    columns = jnp.stack([grid, grid], axis=1)
    sides = jnp.sign(pressing(columns).alpha[:, 0])
    values = deficits(columns, sides)
    middle = values[1:-1]
    inner = (middle >= values[:-2]) & (middle >= values[2:]) & (middle < 0)
    at = jax.lax.top_k(jnp.where(inner, middle, -jnp.inf).T, 2)[1].T + 1
    # alpha itself, not its size: the place wanted is where it is largest beyond 0.
    side = jnp.tile(sides[at[:, 0]], 2)

    def third(_: Any, ends: tuple[Array, Array]) -> tuple[Array, Array]:
        low, high = ends
        left, right = low + (high - low) / 3, high - (high - low) / 3
        both = deficits(jnp.concatenate([left, right]), side)
        rises = both[:2] < both[2:]
        return jnp.where(rises, left, low), jnp.where(rises, high, right)

    ends = jax.lax.fori_loop(0, SETTINGS.ternary, third, (grid[at - 1], grid[at + 1]))
    return (0.5 * (ends[0] + ends[1])).ravel()


def _edges(side: Callable, inside: Array, outside: Array) -> Array:
    """The last coordinates with the side of `inside`, towards `outside`.

    Bisection on the yes or no: bounds of a user's bristle need not be smooth.
    """
    wanted = side(inside)

    def halve(_: Any, ends: tuple[Array, Array]) -> tuple[Array, Array]:
        good, bad = ends
        middle = 0.5 * (good + bad)
        holds = side(middle) == wanted
        return jnp.where(holds, middle, good), jnp.where(holds, bad, middle)

    reached = side(outside) == wanted  # the range itself ends inside
    good, _ = jax.lax.fori_loop(0, SETTINGS.bisections, halve, (inside, outside))
    return jnp.where(reached, outside, good)


def first_places(flags: Bool[Array, "... n"], count: int) -> Int[Array, "... count"]:
    """Indices of the first flags on the last axis, -1 where there are fewer.

    `jnp.nonzero` instead compiles 5 times as long.
    """
    size = flags.shape[-1]
    # Single floats hold these whole numbers, and have a fast top_k: 40 times that of ints.
    ranks = jnp.where(flags, size - np.arange(size, dtype=np.float32), 0).astype(np.float32)
    found = jax.lax.top_k(ranks, count)[0].astype(int)
    return jnp.where(found > 0, size - found, -1)


def scan_admissible(
    fn: Callable[[Real], Real],
    ends: Float[Array, "pieces 2"],
    sides: Float[Array, " pieces"],
) -> Admissible:
    """Look over `fn` on intervals: nodes towards their ends, extrema polished.

    `missed` of the result is of each interval.
    """
    width = ends[:, 1:] - ends[:, :1]
    even = np.arange(1, SETTINGS.even) / SETTINGS.even
    halved = 2.0 ** -np.arange(*SETTINGS.halvings)
    near = jnp.concatenate([jnp.zeros(1), halved[::-1], even[even < 0.5]])[None]
    left, right = ends[:, :1] + width * near, ends[:, 1:] - width * near[:, ::-1]
    middle = ends[:, :1] + 0.5 * width
    nodes = jnp.sort(jnp.concatenate([left, middle, right], axis=1), axis=1)
    every = jax.jit(jax.vmap(jax.vmap(fn)))
    values, slopes = jax.jvp(every, (nodes,), (jnp.ones_like(nodes),))
    size = jnp.max(jnp.abs(values), axis=1)
    flat = jnp.max(values, axis=1) - jnp.min(values, axis=1) <= SETTINGS.flat * size
    places, more = _turns(every, nodes, slopes)
    steps = width * jnp.array([SETTINGS.asides])
    asides = jnp.concatenate([ends[:, :1] + steps, ends[:, 1:] - steps], axis=1)
    turned = jnp.isfinite(places)
    # Empty places go to the end of the interval, where they repeat its last node.
    places = jnp.where(turned, places, ends[:, 1:])
    added = every(jnp.concatenate([places, asides], axis=1))
    every_value = jnp.concatenate([values, added[:, : SETTINGS.turns]], axis=1)
    low, high = _range(every_value, added[:, SETTINGS.turns :], width[:, 0])
    none = jnp.zeros(nodes.shape, bool)
    columns = (
        jnp.concatenate([nodes, places], axis=1),
        every_value,
        jnp.concatenate([none, turned], axis=1),
    )
    order = jnp.argsort(columns[0], axis=1)
    places, values, turned = (jnp.take_along_axis(c, order, axis=1) for c in columns)
    return Admissible(places, values, turned, low, high, flat, sides, more & ~flat)


def _turns(every: Callable, nodes: Array, slopes: Array) -> tuple[Array, Array]:
    """Zeros of the slope between nodes (PIECES, turns), NaN where there are fewer."""
    left, right = slopes[:, :-1], slopes[:, 1:]
    turns = (left * right < 0) | ((left == 0) & (right != 0))
    cells = first_places(turns, SETTINGS.turns)
    before = jnp.take_along_axis(left, cells, axis=1)
    low = jnp.take_along_axis(nodes, cells, axis=1)
    high = jnp.take_along_axis(nodes, cells + 1, axis=1)
    side = jnp.where(before < 0, 1.0, -1.0)
    slope = slope_of(every)
    roots = find_root(lambda x: side * slope(x), low, high)
    roots = jnp.where(before == 0, low, roots)
    return jnp.where(cells >= 0, roots, jnp.nan), jnp.sum(turns, axis=1) > SETTINGS.turns


def _range(values: Array, asides: Array, width: Array) -> tuple[Array, Array]:
    """Least and largest value of each interval; infinite where it grows to a pole.

    `asides` (PIECES, 4): the quantity at `asides` from either end.
    """
    low, high = jnp.min(values, axis=1), jnp.max(values, axis=1)
    for far, close in (asides[:, :2].T, asides[:, 2:].T):
        pole = (jnp.abs(close) > SETTINGS.pole * jnp.abs(far)) & (width > 0)
        low = jnp.where(pole & (close < 0), -jnp.inf, low)
        high = jnp.where(pole & (close > 0), jnp.inf, high)
        zero = (SETTINGS.pole * jnp.abs(close) < jnp.abs(far)) & (width > 0)
        low = jnp.where(zero, jnp.minimum(low, 0.0), low)
        high = jnp.where(zero, jnp.maximum(high, 0.0), high)
    return low, high
