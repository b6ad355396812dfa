"""Derivatives of a piece of steps, in reverse: those of the steps, their times held."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from stepped_scene import CONTROLLER, FIRST, start_of, stepped, stepper_of

from frictionjax.wiggly.sequential.step_adjoint import Ends, made_again

ROOM = 400


def energies(stepper, start, stop, room=ROOM):
    ends = Ends(stepper, jnp.asarray(0.0), start, stop)
    (tip, balance, *_), fits = made_again(ends, CONTROLLER, FIRST, room)
    return tip + 3.0 * balance.viscous, fits


@eqx.filter_jit
def one_step(stepper, begin, end, y, memory):
    after, _, memory, _ = stepper.step(begin, end, y, memory)
    return after, memory


def chained(stepper, start, stop, times):
    """The same steps one after the other, to be differentiated as they stand."""
    y, memory = start, stepper.memory(times[0], stop, start)
    for begin, end in zip(times, [*times[1:], stop], strict=True):
        y, memory = one_step(stepper, begin, end, y, memory)
    return y[0] + 3.0 * y[1].viscous


@pytest.fixture(scope="module")
def point():
    stepper = stepper_of()
    return stepper, start_of(stepper), jnp.asarray(0.03)


def test_values_are_those_of_the_steps(point):
    stepper, _, stop = point
    value, fits = energies(*point)
    now, _ = stepped(stepper, jnp.asarray(0.0), stop)
    assert bool(fits)
    assert float(value) == pytest.approx(
        float(now.y[0] + 3.0 * now.y[1].viscous), rel=1e-13
    )


def test_too_little_room_is_told(point):
    _, fits = energies(*point, room=5)
    assert not bool(fits)


def test_derivatives_are_those_of_the_steps_made_once_more(point):
    stepper, start, stop = point
    now, log = stepped(stepper, jnp.asarray(0.0), stop, room=ROOM)
    times = [jnp.asarray(t) for t in np.asarray(log.t)[: int(now.accepted)]]
    assert 5 < len(times) < 30

    def parts(ends):
        return eqx.filter_grad(lambda e: energies(e[0], e[1], e[2])[0])(ends)

    def plain(ends):
        return eqx.filter_grad(lambda e: chained(e[0], e[1], e[2], times))(ends)

    ends = stepper, start, stop
    ours, theirs = eqx.filter_jit(parts)(ends), plain(ends)  # of which one step is compiled
    found, expected = (
        np.asarray([float(np.sum(leaf)) for leaf in jax.tree_util.tree_leaves(tree)])
        for tree in (ours, theirs)
    )
    assert np.max(np.abs(expected)) > 0.1
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-11)


def test_derivatives_by_the_start_are_finite_differences(point):
    stepper, start, stop = point

    def value(tip):
        return energies(stepper, (tip, *start[1:]), stop)[0]

    slope = float(jax.grad(value)(start[0]))
    step = 1e-5
    difference = float(value(start[0] + step) - value(start[0] - step)) / (2 * step)
    # The difference is by the lengths of the steps too, that is, by their errors.
    assert slope == pytest.approx(difference, rel=5e-3)


def test_no_way_has_the_derivative_one(point):
    stepper, start, _ = point
    zero = jnp.asarray(0.0)
    slope = jax.grad(lambda tip: energies(stepper, (tip, *start[1:]), zero)[0])(start[0])
    assert float(slope) == 1.0
