"""Derivatives along pieces between stops: those of the pieces, none where room runs out."""

from functools import partial
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.wiggly.sequential import segment_adjoint as travel

STOPS, RATE, START = np.array([0.0, 0.35, 0.35, 1.0]), 0.7, 1.3


class Decay(NamedTuple):
    """y' = -rate y, and how many pieces it took."""

    t: jax.Array
    y: jax.Array
    pieces: jax.Array


def decayed(rate, length, front, stop):
    """At most `length` towards the stop, in one step of Euler's method."""
    end = jnp.minimum(stop, front.t + length)
    y = front.y * (1 - rate * (end - front.t))
    return Decay(end, y, front.pieces + 1)


def values(rate, start, stops, again=np.inf):
    front = Decay(jnp.zeros(()), start, jnp.asarray(0))
    forth, back = (
        eqx.filter_closure_convert(partial(decayed, rate, length), front, stops[0])
        for length in (0.1, again)
    )
    goes_on = jax.tree_util.Partial(lambda front, stop: front.t < stop)
    return travel.segment_adjoint((forth, back, front, stops), goes_on).fronts


POINT = jnp.asarray(RATE), jnp.asarray(START), jnp.asarray(STOPS)


def step_by_step(rate, start, stops):
    """The same, written out: pieces end at the stops, or where they have ended."""
    inside = [0.1, 0.2, 0.3], [], [stops[1] + 0.1 * i for i in range(1, 7)]
    y, t, found = start, 0.0, [start]
    for index, ends in enumerate(inside):
        for end in [*map(jax.lax.stop_gradient, ends), stops[index + 1]]:
            y, t = y * (1 - rate * (end - t)), end
        found.append(y)
    return jnp.stack(found)


def test_fronts_are_at_the_stops():
    found = jax.jit(values)(*POINT)
    np.testing.assert_array_equal(found.t, STOPS)
    np.testing.assert_allclose(found.y, step_by_step(*POINT), rtol=1e-14)
    np.testing.assert_array_equal(found.pieces, [0, 4, 4, 11])


def test_derivatives_are_those_of_the_pieces():
    found = jax.jit(jax.jacrev(lambda *p: values(*p).y, (0, 1, 2)))(*POINT)
    expected = list(jax.jacfwd(step_by_step, (0, 1, 2))(*POINT))
    # Nothing is done at a stop that is reached already: the one before it made the way.
    expected[2] = expected[2].at[:, 1].add(expected[2][:, 2]).at[:, 2].set(0.0)
    for ours, theirs in zip(found, expected, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-15)


def test_a_batch_is_its_lanes():
    rates = jnp.array([0.2, 0.7, 1.5])
    slope = jax.jit(jax.grad(lambda rate: jnp.sum(jnp.sin(values(rate, *POINT[1:]).y))))
    np.testing.assert_array_equal(jax.vmap(slope)(rates), [slope(rate) for rate in rates])


@pytest.mark.parametrize(("room", "enough"), [(10, False), (11, True)])
def test_no_derivative_where_room_for_pieces_runs_out(monkeypatch, room, enough):
    """There are eleven."""
    monkeypatch.setattr(travel, "SETTINGS", travel.SETTINGS._replace(most_pieces=room))
    slope = jax.grad(lambda rate: values(rate, *POINT[1:]).y[-1])(RATE)
    assert np.isfinite(slope) == enough


def test_no_derivative_where_a_piece_does_not_reach_its_end_again():
    slope = jax.grad(lambda rate: values(rate, *POINT[1:], again=0.05).y[-1])(RATE)
    assert np.isnan(slope)
