"""Compiled functions of parts: what tells programs apart, and columns in pieces."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jaxtyping import Array

from frictionjax._compile.programs import Program, in_chunks


class Line(eqx.Module):
    """A part with a number and something that is none."""

    slope: Array
    turned: bool = eqx.field(static=True)


@Program
def _on_line(line: Line, places: Array):
    sign = -1.0 if line.turned else 1.0
    return sign * line.slope * places, {"square": places**2}


def test_parts_are_told_apart_by_what_they_are_and_not_by_where_they_were():
    """A part that is gone may leave its place in memory to the next one."""
    places = np.arange(3.0)
    for slope in range(200):
        line = Line(jnp.asarray(float(slope)), turned=slope % 2 == 1)
        sign = -1 if line.turned else 1
        np.testing.assert_array_equal(_on_line(line, places)[0], sign * slope * places)
        del line


def test_what_is_traced_is_not_kept():
    line = Line(jnp.asarray(2.0), turned=False)
    for _ in range(2):  # two functions, so that both are traced
        traced = jax.jit(lambda line: _on_line(line, np.ones(2))[0])
        assert traced(line).tolist() == [2.0, 2.0]
    slope = jax.grad(lambda s: _on_line(Line(s, turned=False), np.ones(2))[0].sum())
    assert [float(slope(s)) for s in (1.0, 3.0)] == [2.0, 2.0]


@pytest.mark.parametrize("count", [1, 3, 4, 5, 8, 11])
def test_columns_in_pieces_are_as_the_whole(count):
    places = np.linspace(0.0, 1.0, count)
    line = Line(jnp.asarray(3.0), turned=True)
    scaled, more = in_chunks(_on_line, 4, (line,), (places,))
    assert isinstance(scaled, np.ndarray)
    assert scaled.tolist() == (-3.0 * places).tolist()
    assert more["square"].tolist() == (places**2).tolist()
