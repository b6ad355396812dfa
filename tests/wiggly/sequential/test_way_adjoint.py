"""Derivatives along the steps from stop to stop: those of the steps, their times held."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from stepped_scene import CONTROLLER, FIRST, start_of, stepper_of

from frictionjax.wiggly import Status
from frictionjax.wiggly.sequential import way_adjoint
from frictionjax.wiggly.sequential.stepper import blank_log, step_to
from frictionjax.wiggly.sequential.way_adjoint import Checkpoint, way_through

ROOM = 400
# One of them at the start, and one twice: nothing is done there.
STOPS = jnp.asarray([0.0, 0.02, 0.02, 0.03])
# Solvers that remember nothing, the slope, and more than the state: a second one.
SOLVERS = [(name, 3840) for name in ("resolved", "Kvaerno3", "ReversibleHeun")]


def way(stepper, start, stops):
    none, (*y, step) = jnp.asarray(0), start
    front = Checkpoint(jnp.zeros(()), tuple(y), step, none + Status.OK, none, none)
    limits = jnp.asarray(1e-12), 10_000
    return way_through((stepper, front, stops), CONTROLLER, limits)


def measured(y):
    return y[0] + 3.0 * y[1].viscous


def energies(given):
    """At all stops, with weights."""
    past = way(*given)
    found = jnp.sum(jnp.arange(1.0, STOPS.size + 1) * measured(past.fronts.y))
    return found + jnp.sum(past.fronts.t), past


def slopes():
    """A program of its own for each setting."""

    def fresh(given):
        return energies(given)

    return eqx.filter_jit(eqx.filter_value_and_grad(fresh, has_aux=True))


@eqx.filter_jit
def times_inside(stepper, start, t, tip, step, end):
    """Where the steps of a piece begin."""
    y = tip, *start[1:-1], step
    log = blank_log(stepper, y, ROOM)
    now, log = step_to(end, stepper, CONTROLLER, t, y, step, most=ROOM, log=log)
    return log.t, now.accepted


def chained(given, stretches):
    """The same steps one after the other, to be differentiated as they stand."""
    stepper, y, stops = given
    t, total = jnp.zeros(()), 0.0
    for index, pieces in enumerate(stretches):
        for inside, end in pieces:
            end = stops[index] if end is None else end
            memory = stepper.memory(t, end, y)
            moving, still = eqx.partition(memory, eqx.is_array)

            def step(now, between, still=still):
                y, memory = now
                y, _, memory, _ = stepper.step(*between, y, eqx.combine(memory, still))
                memory = jax.tree_util.tree_map(jnp.asarray, memory)
                return (y, eqx.filter(memory, eqx.is_array)), None

            times = jnp.concatenate([t[None], inside, end[None]])
            (y, _), _ = jax.lax.scan(step, (y, moving), (times[:-1], times[1:]))
            t = end
        total = total + (index + 1) * measured(y) + t
    return total


def pieces_of(past, stepper, start):
    """Of each stop, times inside and the end; None for a piece that ends at the stop."""
    made, rows = np.asarray(past.made), past.pieces[:4]
    stretches, first = [], 0
    for last in made:
        own = []
        for index in range(first, last):
            *begin, end = (row[index] for row in rows)
            times, count = times_inside(stepper, start, *begin, end)
            own.append((times[1 : int(count)], None if index == last - 1 else end))
        stretches.append(own)
        first = last
    return stretches


@pytest.mark.slow  # two programs each; that of all steps: ../test_differentiable.py
@pytest.mark.parametrize(("solver", "length"), [("resolved", 3), *SOLVERS])
def test_derivatives_are_those_of_the_steps(solver, length, monkeypatch):
    short = way_adjoint.SETTINGS._replace(piece=length)
    monkeypatch.setattr(way_adjoint, "SETTINGS", short)
    stepper = stepper_of(solver)
    point = stepper, start_of(stepper), STOPS
    (value, past), ours = slopes()(point)
    assert np.all(past.fronts.code == Status.OK)
    np.testing.assert_array_equal(past.fronts.t, STOPS)
    stretches = pieces_of(past, *point[:2])
    assert [len(own) > 0 for own in stretches] == [False, True, False, True]
    assert (len(stretches[1]) > 1) == (length == 3)
    expected, theirs = eqx.filter_jit(eqx.filter_value_and_grad(chained))(point, stretches)
    assert float(value) == pytest.approx(float(expected), rel=1e-11)
    # The length of the longest step is a number.
    theirs = eqx.tree_at(lambda by: by[1][-1], theirs, jnp.zeros(()))
    found, wanted = (
        np.concatenate([np.ravel(leaf) for leaf in jax.tree_util.tree_leaves(tree)])
        for tree in (ours, theirs)
    )
    assert np.max(np.abs(wanted)) > 0.1
    np.testing.assert_allclose(found, wanted, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("lacks", ["pieces", pytest.param("steps", marks=pytest.mark.slow)])
def test_no_derivative_where_room_runs_out(monkeypatch, lacks):
    stepper = stepper_of()
    settings = way_adjoint.SETTINGS._replace(piece=3)
    lack = {"pieces": {"most_pieces": 2}, "steps": {"more": -2}}[lacks]
    monkeypatch.setattr(way_adjoint, "SETTINGS", settings._replace(**lack))
    (value, _), by = slopes()((stepper, start_of(stepper), STOPS))
    assert np.isfinite(value)
    assert np.isnan(by[1][0])


@pytest.mark.slow  # a program of its own
def test_a_batch_is_its_lanes():
    stepper, stops = stepper_of(), jnp.asarray([[0.01, 0.02], [0.005, 0.03]])

    @jax.jit
    def slope(stops):
        def last(tip):
            start = tip, *start_of(stepper)[1:-1], FIRST
            return way(stepper, start, stops).fronts.y[0][-1]

        return jax.grad(last)(start_of(stepper)[0])

    batch = jax.vmap(slope)(stops)
    np.testing.assert_allclose(batch, [slope(own) for own in stops], rtol=1e-9)
    assert np.all(batch < 0.9)
