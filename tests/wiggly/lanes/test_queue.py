"""Queues of lanes: what one finds does not depend on those beside it."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.numerics import rows_of
from frictionjax.wiggly.enclosure import marching
from frictionjax.wiggly.lanes import loops, march
from frictionjax.wiggly.lanes.settings import SETTINGS

SCENE = fx.Scene(
    fx.profiles.Fourier([0.0, 0.01], [0.1, 0.0]),
    fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5),
    fx.supports.Spring(1.0),
    fx.loads.Triangle(1.0, period=2.0),
    duration=1.5,
)


@pytest.fixture(scope="module")
def marched():
    """What the largest queue of a solve is asked, and what it finds."""
    asked = []

    def noted(*args):
        asked.append((args, march(*args)))
        return asked[-1][1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(marching, "march", noted)
        fx.solve(SCENE, 0.002, 0.9, np.linspace(0, 1.5, 31), method="windowed")
    return max(asked, key=lambda one: one[0][2].cell.size)


def alone(args, chosen):
    """Ends of the legs of some jobs, in that order, in a queue of their own."""
    scene, cells, jobs, legs, tableau, summed, work = args
    mine = rows_of(jobs, chosen)
    own = [np.arange(a, b) for a, b in zip(mine.first_leg, mine.past_leg, strict=True)]
    rows, past = np.concatenate(own), np.cumsum([len(r) for r in own])
    mine = mine._replace(first_leg=past - [len(r) for r in own], past_leg=past)
    part = march(scene, cells, mine, rows_of(legs, rows), tableau, summed, work[chosen])
    return rows, part


@pytest.mark.parametrize("order", ["backwards", "one", "few", "every other"])
def test_what_a_lane_finds_is_the_same_in_any_queue_to_the_last_bit(marched, order):
    args, found = marched
    every = np.arange(args[2].cell.size)
    assert every.size > 4
    orders = {
        "backwards": every[::-1],
        "one": every[1:2],
        "few": every[:3],
        "every other": every[::2],
    }
    rows, part = alone(args, orders[order])
    for column, whole in zip(part, found, strict=True):
        np.testing.assert_array_equal(column, whole[rows])


def test_a_lane_that_fails_says_so_at_each_stop_and_others_go_on(marched):
    args, found = marched
    scene, cells, jobs, legs, *rest = args
    first, past = int(jobs.first_leg[0]), int(jobs.past_leg[0])
    budget = np.array(legs.budget, dtype=float)
    budget[first] = 1.0
    part = march(scene, cells, jobs, legs._replace(budget=budget), *rest)
    assert (part.code[first:past] == int(fx.Status.MAX_STEPS)).all()
    assert np.isnan(part.tip[first:past]).all()
    others = np.delete(np.arange(part.tip.size), np.arange(first, past))
    np.testing.assert_array_equal(part.tip[others], found.tip[others])


def test_the_patience_of_a_job_is_for_all_of_its_legs(marched):
    """Budgets are for each leg: lanes of ten thousand legs went on for minutes."""
    args, found = marched
    scene, cells, jobs, legs, *rest = args
    count = jobs.past_leg - jobs.first_leg
    one = int(np.argmax(count))
    mine = np.arange(jobs.first_leg[one], jobs.past_leg[one])
    assert mine.size > 4
    middle = mine.size // 2
    patience = np.full(count.size, np.inf)
    patience[one] = found.steps[mine[:middle]].sum() + 0.5
    part = march(scene, cells, jobs._replace(patience=patience), legs, *rest)
    assert (part.code[mine[:middle]] == 0).all()
    assert (part.code[mine[middle:]] == int(fx.Status.MAX_STEPS)).all()
    others = np.delete(np.arange(part.tip.size), mine[middle:])
    np.testing.assert_array_equal(part.tip[others], found.tip[others])


def test_more_jobs_than_lanes_are_all_gone_through(marched):
    args, found = marched
    many = np.tile(
        np.arange(args[2].cell.size), 1 + 3 * SETTINGS.width // args[2].cell.size
    )
    rows, part = alone(args, many)
    assert many.size > SETTINGS.width
    np.testing.assert_array_equal(part.tip, found.tip[rows])
    assert (part.code == 0).all()


@pytest.mark.parametrize("width", [SETTINGS.narrow, SETTINGS.width])
def test_a_loop_without_sums_goes_the_same_way_to_the_last_bit(monkeypatch, marched, width):
    """So that whichever is there can serve."""
    args, found = marched
    monkeypatch.setattr(loops._LOOPS, "choose", lambda *_: (False, width))
    part = march(*args)
    for column in ("well", "tip", "speed", "steps", "rejected", "code"):
        np.testing.assert_array_equal(getattr(part, column), getattr(found, column))
    assert (part.work == 0).all()
    assert (found.work != 0).any()
