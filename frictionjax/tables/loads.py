"""Loads as tables: a sum of a ramp, a sine and a zigzag, or points."""

from functools import cache, singledispatch

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from .._checks import Real, as_real, exchanged, is_concrete
from .._compile import Interpreted, in_chunks
from ..loads import (
    AbstractLoad,
    AbstractPull,
    PiecewiseLinear,
    Pulled,
    Ramp,
    Sine,
    Triangle,
)
from .fitted_pieces import fitted_pieces
from .pieces import Binned, binned
from .settings import SETTINGS, size_for


class StraightSum(AbstractPull):
    """A ramp and a triangle, added up."""

    ramp: Ramp
    triangle: Triangle

    def __call__(self, t: Real) -> Real:
        return self.ramp(t) + self.triangle(t)


class SumOfLoads(AbstractPull):
    """What is straight between kinks, and a sine: one program for ramp, triangle, sine."""

    straight: StraightSum
    sine: Sine

    def __call__(self, t: Real) -> Real:
        return self.straight(t) + self.sine(t)


_GOLDEN = 0.5 * (5**0.5 - 1)  # places so far apart fill a stretch evenly


@cache
def _nothing() -> SumOfLoads:
    """A load of 0 N; built anew for every scene it took 0.7 ms."""
    with jax.ensure_compile_time_eval():
        zero, one = as_real(0.0), as_real(1.0)
        return SumOfLoads(StraightSum(Ramp(zero), Triangle(zero, one)), Sine(zero, one))


def bent_part(load: AbstractPull) -> AbstractPull:
    """What of a table is not straight between kinks: a sine; functions as they are."""
    if isinstance(load, SumOfLoads):
        return load.sine
    return _nothing().sine if isinstance(load, PiecewiseLinear) else load


def straight_part(load: AbstractPull) -> AbstractPull:
    """The rest of a table, straight between kinks."""
    if isinstance(load, SumOfLoads):
        return load.straight
    return load if isinstance(load, PiecewiseLinear) else _nothing().straight


@singledispatch
def _table_of(load: AbstractPull) -> AbstractPull:
    return load


def _straight(**part: AbstractPull) -> SumOfLoads:
    none = _nothing()
    return exchanged(none, {"straight": exchanged(none.straight, part)})


@_table_of.register
def _(load: Ramp) -> SumOfLoads:
    return _straight(ramp=load)


@_table_of.register
def _(load: Sine) -> SumOfLoads:
    return exchanged(_nothing(), {"sine": load})


@_table_of.register
def _(load: Triangle) -> SumOfLoads:
    return _straight(triangle=load)


@_table_of.register
def _(load: PiecewiseLinear) -> PiecewiseLinear:
    times, values = np.asarray(load.times), np.asarray(load.values)
    # One point is constant: so are two.
    size = size_for(max(times.size, 2), SETTINGS.points)
    if size is None:
        return load
    more = size - times.size
    beyond = times[-1] + (1 + np.arange(more)) * max(1.0, abs(float(times[-1])))
    times = np.concatenate([times, beyond])
    return PiecewiseLinear(
        jnp.asarray(times), jnp.asarray(np.pad(values, (0, more), "edge"))
    )


@_table_of.register
def _(load: Pulled) -> AbstractPull:
    table = _table_of(load.position)
    k = jnp.asarray(load.stiffness)
    if isinstance(table, PiecewiseLinear):
        return exchanged(table, {"values": load.of_place(table.values)})
    if not isinstance(table, SumOfLoads):
        return load
    straight, sine = table.straight, table.sine
    ramp = exchanged(
        straight.ramp,
        {"rate": k * straight.ramp.rate, "start": load.of_place(straight.ramp.start)},
    )
    triangle = _times(straight.triangle, k)
    straight = exchanged(straight, {"ramp": ramp, "triangle": triangle})
    return exchanged(table, {"straight": straight, "sine": _times(sine, k)})


def _times(load: Sine | Triangle, factor: Real) -> AbstractPull:
    return exchanged(load, {"amplitude": factor * load.amplitude})


def load_table(load: AbstractPull) -> AbstractPull:
    """The load as one of a few classes of a few sizes; itself where it is a function."""
    return _table_of(load) if is_concrete(load) else load


class PiecewiseLoad(AbstractPull):
    """A function on [0, duration] (s) in pieces, as in `Binned`, at shares of it.

    `steepest`: where it is known to be, s; NaN where it is not.
    """

    rows: Float[Array, "pieces columns"]
    first: Int[Array, " bins"]
    duration: Real
    steepest: Real

    def __call__(self, t: Real) -> Real:
        return Binned(self.rows, self.first)(t / self.duration)


@Interpreted
def _values(load: AbstractPull, times: Array) -> Array:
    return jax.vmap(load)(times)


def load_in_pieces(
    load: AbstractPull, turning_points: Float[np.ndarray, " n"], duration: float
) -> AbstractPull:
    """The table of a known load; a function in pieces, itself where none meet it.

    `turning_points`: those inside (0, duration), and kinks, in s: there pieces end.
    """
    table = load_table(load)
    if isinstance(table, SumOfLoads | PiecewiseLinear):
        return table

    def values(places: np.ndarray) -> np.ndarray:
        return in_chunks(_values, SETTINGS.times, (table,), (duration * places,))

    known = getattr(table, "steepest", None)
    steepest = float("nan" if known is None else known)
    inside = [steepest] if 0 < steepest < duration else []
    edges = np.unique([0.0, *turning_points, *inside, duration]) / duration
    pieces = fitted_pieces(values, edges)
    found = None if pieces is None else binned(pieces, SETTINGS.function_bins)
    if found is None:
        return table
    load = PiecewiseLoad(*found, jnp.asarray(duration), jnp.asarray(steepest))
    return load if _say_the_same(table, load, duration) else table


def _say_the_same(load: AbstractPull, pieces: AbstractPull, duration: float) -> bool:
    """Whether they do at times that pieces were not made of, all over the duration."""
    times = duration * np.mod(_GOLDEN * np.arange(SETTINGS.times), 1.0)
    one, other = _values(load, times), _values(pieces, times)
    return bool(np.max(np.abs(one - other)) <= SETTINGS.same * np.max(np.abs(one)))


class LoadOnEdges(AbstractLoad):
    """A load whose kinks and turns are `edges` (n,) in s: one class for all tables.

    What is straight between them: `values` (n,) in N there, and `rates` (n,) in N/s from
    there on. Edges rise from 0 to the duration, which fills the room.
    """

    bent: AbstractPull
    edges: Float[Array, " n"]
    values: Float[Array, " n"]
    rates: Float[Array, " n"]

    def __call__(self, t: Real) -> Real:
        k = self._before(t)
        return self.bent(t) + (self.values[k] + self.rates[k] * (t - self.edges[k]))

    def slope(self, t: Real) -> Real:
        return self.bent.slope(t) + self.rates[self._before(t)]

    def _before(self, t: Real) -> Int[Array, ""]:
        found = jnp.searchsorted(self.edges, t, side="right", method="compare_all")
        return jnp.maximum(found - 1, 0)

    @property
    def steepest(self) -> Real | None:
        """Where a function is known to be steepest, s."""
        return getattr(self.bent, "steepest", None)

    def turning_count(self, duration: float) -> int:
        return self.edges.shape[0] - 1

    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        return jnp.minimum(self.edges[1:], duration)


@Interpreted
def _lines(straight: AbstractPull, edges: Array) -> tuple[Array, Array]:
    return jax.vmap(straight)(edges), jax.vmap(straight.slope)(edges)


def load_on_edges(table: AbstractPull, edges: Float[np.ndarray, " n"]) -> LoadOnEdges:
    """A table, or a function, of a load that has its kinks and turns at known edges (s)."""
    lines = (jnp.asarray(column) for column in _lines(straight_part(table), edges))
    return LoadOnEdges(bent_part(table), jnp.asarray(edges), *lines)
