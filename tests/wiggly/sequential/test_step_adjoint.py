"""Derivatives of a piece of steps, in reverse: those of the steps, their times held."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from stepped_scene import CONTROLLER, FIRST, start_of, stepped, stepper_of

from frictionjax.wiggly.sequential.step_adjoint import Ends, made_again

ROOM = 400


@eqx.filter_jit
def energies(stepper, start, stop, room=ROOM):
    """The value, whether there was room, derivatives by the first three: one program."""

    def value(given):
        stepper, start, stop = given
        ends = Ends(stepper, jnp.asarray(0.0), start, stop)
        (tip, balance, *_), fits = made_again(ends, CONTROLLER, FIRST, room)
        return tip + 3.0 * balance.viscous, fits

    slopes = eqx.filter_value_and_grad(value, has_aux=True)
    (found, fits), by = slopes((stepper, start, stop))
    return found, fits, by


@eqx.filter_jit
@eqx.filter_grad
def chained(given, times):
    """The same steps one after the other, to be differentiated as they stand."""
    stepper, start, stop = given
    moving, still = eqx.partition(stepper.memory(times[0], stop, start), eqx.is_array)

    def step(now, between):
        y, memory = now
        y, _, memory, _ = stepper.step(*between, y, eqx.combine(memory, still))
        return (y, eqx.filter(memory, eqx.is_array)), None

    between = times, jnp.append(times[1:], stop)
    (y, _), _ = jax.lax.scan(step, (start, moving), between)
    return y[0] + 3.0 * y[1].viscous


@pytest.fixture(scope="module")
def point():
    stepper = stepper_of()
    return stepper, start_of(stepper), jnp.asarray(0.03)


@pytest.mark.slow  # a program of its own; that of all steps: ../test_differentiable.py
def test_values_are_those_of_the_steps(point):
    stepper, _, stop = point
    value, fits, _ = energies(*point)
    now, _ = stepped(stepper, jnp.asarray(0.0), stop)
    assert bool(fits)
    assert float(value) == pytest.approx(
        float(now.y[0] + 3.0 * now.y[1].viscous), rel=1e-13
    )


def test_too_little_room_is_told(point):
    stepper, start, stop = point
    ends = Ends(stepper, jnp.asarray(0.0), start, stop)
    _, fits = eqx.filter_jit(made_again)(ends, CONTROLLER, FIRST, 5)
    assert not bool(fits)


@pytest.mark.slow
def test_derivatives_are_those_of_the_steps_made_once_more(point):
    stepper, _, stop = point
    now, log = stepped(stepper, jnp.asarray(0.0), stop)
    times = log.t[: int(now.accepted)]
    assert 5 < times.size < 30
    ours, theirs = energies(*point)[2], chained(point, times)
    found, expected = (
        np.asarray([float(np.sum(leaf)) for leaf in jax.tree_util.tree_leaves(tree)])
        for tree in (ours, theirs)
    )
    assert np.max(np.abs(expected)) > 0.1
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-11)


@pytest.mark.slow  # a program of its own
def test_derivatives_by_the_start_are_finite_differences(point):
    stepper, start, stop = point

    def at(tip):
        return energies(stepper, (tip, *start[1:]), stop)

    slope = float(at(start[0])[2][1][0])
    step = 1e-5
    difference = float(at(start[0] + step)[0] - at(start[0] - step)[0]) / (2 * step)
    # The difference is by the lengths of the steps too, that is, by their errors.
    assert slope == pytest.approx(difference, rel=5e-3)


@pytest.mark.slow  # a program of its own
def test_no_way_has_the_derivative_one(point):
    stepper, start, _ = point
    by_start = energies(stepper, start, jnp.asarray(0.0))[2][1]
    assert float(by_start[0]) == 1.0
