"""Steps at folds: rounding is no reason to stay there, or to follow what is unstable."""

import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.wiggly.equation.field import Point
from frictionjax.wiggly.lanes.fold_steps import foothold, pause_of

DRAG, WIDTH = 1e-24, 0.2  # eps = 1e-12, gamma = 1


def point(velocity=0.0, by_state=1e23, by_time=1e20, load=1.0) -> Point:
    """At a rest in the middle of an unstable branch, where the load rises."""
    values = velocity, by_state, by_time, 0.9, 1.0, load
    return Point(*[jnp.asarray(value) for value in values])


def at(place: Point, step=1e-20, time=0.75):
    return foothold(jnp.asarray(step), place, jnp.asarray(time), jnp.asarray(DRAG), WIDTH)


@pytest.mark.parametrize("step", [1e-2, 1e-10, 1e-22])
def test_no_step_follows_an_unstable_branch(step):
    assert at(point(), step).overgrown() > 1
    assert at(point(by_state=-1e23), step).overgrown() <= 0
    assert at(point(by_state=0.1 / step), step).overgrown() < 0.1


def test_a_tip_that_nothing_moves_stays_even_where_it_is_unstable():
    balanced = at(point(by_time=0.0), 1.0)
    assert balanced.overgrown() == 0
    assert balanced.velocity() == 0


@pytest.mark.parametrize("by_time", [1e20, -1e20, 1.0, -1e30])
def test_rests_on_unstable_branches_end_where_the_load_draws(by_time):
    pushed = float(at(point(by_time=by_time)).velocity())
    assert np.sign(pushed) == np.sign(by_time)
    rounding = np.finfo(float).eps * (1 + WIDTH) / DRAG
    assert rounding < abs(pushed) < 100 * rounding + 100 * 2**-52 * abs(by_time)
    assert at(point(by_state=-1e23)).velocity() == 0
    assert at(point(3.0)).velocity() == 3.0


@pytest.mark.parametrize("slope", [-1e23, -1e17, 1e17])
def test_errors_are_those_of_rounding_where_forces_cancel(slope):
    """Below that no step is short enough; above it errors stay what they are."""
    here = at(point(by_state=slope, by_time=1.0), 1e-4)
    rounding = np.finfo(float).eps * (1 + WIDTH) / DRAG / abs(slope)
    assert here.beyond_rounding(jnp.asarray(0.5 * rounding), here.point) == 0
    far = here.beyond_rounding(jnp.asarray(100 * rounding), here.point)
    assert float(far) == pytest.approx(100 * rounding, rel=0.1)


def test_a_step_from_a_fold_itself_may_not_go_anywhere():
    fold, beyond = point(by_state=0.0, by_time=1.0), point(by_state=1e20)
    error = jnp.asarray(1e-3)
    assert at(fold, 1e-4).beyond_rounding(error, beyond) == pytest.approx(1e-3, rel=0.1)


def test_a_step_into_a_slip_shows_it_or_leaves_little_of_its_energy():
    start = at(point(by_state=-1e15), 1e-20)
    assert start.resolves(point(1e20, by_state=1e20))
    assert start.resolves(point(1e19, by_state=1e22))
    assert not start.resolves(point(1e22, by_state=1e22))


@pytest.mark.parametrize("time", [0.0, 0.3, -2.5, 1e6])
def test_rests_last_until_floats_at_t_go_on(time):
    moving = 1e25  # periods a second, the square of a second: 10 N/s
    pause = pause_of(point(by_state=-1e20, by_time=moving), jnp.asarray(time), DRAG)
    assert np.spacing(abs(time)) <= pause <= 2 * np.spacing(abs(time)) or time == 0
    for other in (point(by_state=1e20), point(1e-9, by_state=-1e20)):
        assert pause_of(other, jnp.asarray(time), DRAG) == 0


@pytest.mark.parametrize("slope", [1e-3, 1e-5, 0.0])
def test_rests_last_until_floats_of_a_slow_load_go_on(slope):
    still = point(by_state=-1e20, by_time=slope / DRAG)
    pause = float(pause_of(still, jnp.asarray(0.75), DRAG))
    assert pause * slope == pytest.approx(0.5 * np.spacing(1.0) if slope else 0.0)
    assert np.spacing(0.75) < pause < 1e-10


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("before", "after", "way", "uneven"),
    [
        (1.0, 4.0, 1.7, True),  # 2.5 were even
        (1.0, 4.0, 2.4, False),
        (1.0, 4.0, 1.2, False),  # more than its way off: it rests, then slips
        (4.0, 1.0, 1.7, False),  # slows down
        (2.0, 2.2, 1.5, False),  # slower than at either end: comes to a branch first
        (1.0, 1.5, 2.0, False),  # faster than at either end: through a slip
        (5.0, 20.0, 8.5, False),  # as fast as slides
    ],
)
def test_even_steps_may_speed_up(sign, before, after, way, uneven):
    start, end = (point(sign * velocity) for velocity in (before, after))
    asked = jnp.asarray(sign * way), jnp.asarray(10.0), jnp.asarray(1e-6)
    found = at(start, 1.0).uneven(end, *asked)
    assert (found > 1) == uneven
    # A tolerance that allows as much is none.
    assert at(start, 1.0).uneven(end, *asked[:2], jnp.asarray(3.0)) <= 1
