"""Loads as tables: a sum of a ramp, a sine and a zigzag, or points."""

from functools import cache, singledispatch

import jax
import jax.numpy as jnp
import numpy as np

from .._checks import Real, as_real, exchanged, is_concrete
from ..loads import AbstractPull, PiecewiseLinear, Pulled, Ramp, Sine, Triangle
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
