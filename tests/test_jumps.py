"""Loads that jump: slides that are over before the tip follows."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.wiggly.find_path import path_of
from frictionjax.wiggly.job_queue import Arrivals, Jobs, Legs
from frictionjax.wiggly.planning import lane_scene, planned
from frictionjax.wiggly.rounds import PATIENCE, Rounds
from frictionjax.wiggly.windows import Plan


def scene_under(times, values):
    parts = fx.bristles.VerticalSpring(1.0, 2.0, 1.0), fx.supports.Spring(1.0)
    load = fx.loads.PiecewiseLinear(times, values)
    return fx.Scene(fx.profiles.Sine(0.1), *parts, load, times[-1])


@pytest.mark.slow
def test_tips_may_catch_up_with_thousands_of_wells_on_a_leg():
    """The path rests there: the budget for its own wells ended with max_steps."""
    scene = scene_under([0.0, 0.01, 0.0101, 0.02], [0.0, 0.05, 0.9, 0.9])
    ts = np.linspace(0.0, 0.02, 41)
    found = fx.solve(scene, 1e-4, 0.75, ts)
    known = fx.solve(scene, 1e-4, 0.75, ts, 1e-5, "Dopri8", max_steps=10**6)
    assert found.ok
    assert known.ok
    behind = np.abs(np.asarray(fx.solve_limit(scene, ts).z) - np.asarray(found.z))
    assert behind.max() > 3000 * 1e-4
    assert np.abs(np.asarray(found.z - known.z)).max() < 1e-3 * 1e-4
    spent, whole = float(found.dissipation[-1]), float(known.dissipation[-1])
    assert spent == pytest.approx(whole, rel=1e-3)


@pytest.mark.parametrize(("rise", "alone"), [(1e-4, True), (0.5, False)])
def test_one_lane_goes_through_where_slides_are_brief(rise, alone):
    """Brackets across them do not close: maps and brackets took 18 s in vain."""
    scene = scene_under([0.0, 1.0, 1.0 + rise, 2.0], [0.0, 1.0, 2.0, -1.0])
    cells = np.array([1e-4]), np.array([0.5])
    lanes = lane_scene(scene, 1e-4)
    plan = planned(scene, lanes, path_of(scene), *cells, 2, 1e-3, "auto")
    assert plan.ridden.tolist() == [not alone]
    assert np.isinf(plan.needs.tile).tolist() == [alone]


def test_cells_wait_for_lanes_of_brackets_so_long_only():
    """There was no answer in 10 minutes; lanes from a known start have their own budget."""
    none, cell = np.zeros(4), np.array([0, 1, 0, 1])
    first = np.array([0, 1, 2, 4])
    jobs = Jobs(cell, none, none, none, first, np.array([1, 2, 4, 5]))
    legs = Legs(*np.full((len(Legs._fields), 5), 1e9))
    known = np.array([False, True])  # of the window in each cell
    plan = Plan(jobs, legs, none, none, none, none, known, known, none, none)
    rounds = Rounds(*[None] * 12)._replace(waited=np.zeros(2))
    able, some = rounds._within_patience(plan)
    assert able.all()
    assert some.legs.budget.tolist() == [PATIENCE, 1e9, PATIENCE, PATIENCE, PATIENCE]
    steps = PATIENCE * np.array([0.3, 5.0, 0.3, 0.4, np.nan])
    rounds._wait(plan, Arrivals(*np.tile(steps, (len(Arrivals._fields), 1))))
    assert (rounds.waited / PATIENCE).tolist() == pytest.approx([0.7, 0.0])
    rounds._wait(plan, Arrivals(*np.tile(steps, (len(Arrivals._fields), 1))))
    assert rounds._within_patience(plan)[0].tolist() == [False, True, False, True]
