"""Steps in a loop of our own: those that diffrax makes."""

from functools import partial

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from stepped_scene import CONTROLLER, FIRST, start_of, stepped, stepper_of

from frictionjax.wiggly import Status
from frictionjax.wiggly.sequential.augmented_solver import augmented_field


@pytest.mark.parametrize("stop", [0.05, 0.7])
def test_steps_are_those_of_diffrax(stop):
    stepper = stepper_of()
    ours, _ = stepped(stepper, jnp.asarray(0.0), jnp.asarray(stop))
    theirs = diffrax.diffeqsolve(
        diffrax.ODETerm(augmented_field(stepper.field)),
        stepper.solver,
        jnp.asarray(0.0),
        jnp.asarray(stop),
        FIRST,
        start_of(stepper),
        stepsize_controller=CONTROLLER,
    )
    assert int(ours.steps) == int(theirs.stats["num_steps"])
    assert int(ours.accepted) == int(theirs.stats["num_accepted_steps"])
    for mine, other in zip(
        jax.tree_util.tree_leaves(ours.y), jax.tree_util.tree_leaves(theirs.ys), strict=True
    ):
        np.testing.assert_allclose(mine, other[-1], rtol=1e-9, atol=1e-13)


def test_a_stop_that_is_reached_already_takes_no_step():
    stepper = stepper_of()
    now, _ = stepped(stepper, jnp.asarray(0.3), jnp.asarray(0.3))
    assert int(now.steps) == 0
    assert int(now.code) == int(Status.OK)
    np.testing.assert_array_equal(now.y[0], start_of(stepper)[0])


def test_no_more_steps_than_asked_for():
    stepper = stepper_of()
    now, _ = stepped(stepper, jnp.asarray(0.0), jnp.asarray(0.7), most=9)
    assert int(now.steps) == 9
    assert float(now.t) < 0.7


def test_the_log_holds_where_accepted_steps_began():
    stepper = stepper_of()
    now, log = stepped(stepper, jnp.asarray(0.0), jnp.asarray(0.4))
    count = int(now.accepted)
    assert 10 < count < int(now.steps)  # some were rejected, and are written over
    times = np.asarray(log.t)[:count]
    assert times[0] == 0.0
    assert np.all(np.diff(times) > 0)
    assert float(now.t) == 0.4

    @jax.jit
    def again(index):
        tip, memory = jax.tree_util.tree_map(lambda leaf: leaf[index], log[1:3])
        y = tip, *start_of(stepper)[1:]
        after, *_ = stepper.step(log.t[index], log.t[index + 1], y, memory)
        return after[0]

    # Each again, from its place in the log, ends where the next begins.
    for index in (3, count // 2, count - 2):
        np.testing.assert_allclose(again(index), log.tip[index + 1], rtol=1e-12)


def test_a_batch_takes_the_steps_of_its_lanes():
    stepper = stepper_of()
    stops = jnp.asarray([0.05, 0.3, 0.6])
    batch, _ = jax.jit(jax.vmap(partial(stepped, stepper, jnp.asarray(0.0))))(stops)
    for index, stop in enumerate(stops):
        alone, _ = stepped(stepper, jnp.asarray(0.0), stop)
        assert int(batch.steps[index]) == int(alone.steps)
        np.testing.assert_allclose(batch.y[0][index], alone.y[0], rtol=1e-12)


def test_what_is_no_number_makes_steps_shorter_until_they_are_too_short():
    stepper = stepper_of()
    broken = eqx.tree_at(lambda s: s.field.eps, stepper, jnp.asarray(jnp.nan))
    now, _ = stepped(broken, jnp.asarray(0.0), jnp.asarray(0.7), most=500)
    assert int(now.accepted) == 0
