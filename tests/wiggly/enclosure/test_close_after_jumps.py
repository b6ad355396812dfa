"""Loads that jump: slides that are over before the tip follows."""

import numpy as np
import pytest
from paths import path_of

import frictionjax as fx
from frictionjax.model import tabulated_scene
from frictionjax.wiggly.enclosure.brackets import BracketPlan
from frictionjax.wiggly.enclosure.marching import BracketContext, no_effort
from frictionjax.wiggly.enclosure.settings import SETTINGS
from frictionjax.wiggly.enclosure.starts import CellBounds
from frictionjax.wiggly.lanes.queue import Lanes, SegmentEnds, Segments
from frictionjax.wiggly.plan import planned
from frictionjax.wiggly.ways import Way


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
    plan = planned(tabulated_scene(scene, 1e-4), path_of(scene), *cells, 2, 1e-3, "auto")
    assert plan.way == (Way.ONE_LANE if alone else Way.SLIP_MAP)
    assert np.isinf(plan.needs.tile).tolist() == [alone]


def test_cells_wait_for_lanes_that_go_astray_so_long_only():
    """There was no answer in 10 minutes; one lane alone has its own budget.

    Of a cell that remembers 1e5 wells all steps count, whatever wells its lanes go through.
    """
    scene = scene_under([0.0, 1.0], [0.0, 1.1])  # one way of 1 m
    eps, none = np.array([1e-4, 1e-5, 1e-6]), np.zeros(6)
    every = dict.fromkeys(CellBounds._fields, None) | {"eps": eps}
    every["affordable"] = np.full(3, SETTINGS.affordable)
    every["memories"] = np.array([[0.0, 0.0], [0.0, 0.0], [0.0, 0.1]])
    blank = BracketContext(*[None] * 11)._replace(effort=no_effort(3), path=path_of(scene))
    rounds = blank._replace(ground=CellBounds(**every))
    segments = Segments(*np.zeros((len(Segments._fields), 6)))._replace(
        budget=np.full(6, 1e9)
    )
    segments = segments._replace(guide1=np.array([0.0, 0.0, 0.0, 1e-3, 0.0, 1e-5]))
    cell, known = np.array([0, 1, 2, 0, 1, 2]), np.array([True, False, True])
    jobs = Lanes(cell, none, none, none, np.arange(6), np.arange(1, 7))
    plan = BracketPlan(
        jobs, segments, none, none, none, none, known, known, none, none, none
    )
    able, some = rounds._within_patience(plan)
    assert able.all()
    beyond = some.segments.budget - SETTINGS.patience
    assert beyond == pytest.approx(
        [1e9 - SETTINGS.patience, 0, 0, 200 * 10, 0, 0], abs=1e-6
    )
    beyond = some.jobs.patience - SETTINGS.patience
    assert beyond == pytest.approx([np.inf, 0, 0, 2000 * 10, 0, 0], abs=1e-6)
    steps = SETTINGS.patience * np.array([5.0, 0.6, 0.2, 0.3, 0.4, np.nan])
    found = SegmentEnds(*np.tile(steps, (len(SegmentEnds._fields), 1)))._replace(code=none)
    waited = rounds._waited(plan, found)
    assert waited == pytest.approx(
        SETTINGS.patience * np.array([0.3, 0.6, 0.2]), abs=2000.1
    )
    gave_up = found._replace(code=np.array([0, 0, 0, 1.0, 0, 0]))
    assert rounds._waited(plan, gave_up)[0] == 0.3 * SETTINGS.patience
    twice = rounds.effort._replace(waited=2 * waited)
    able = rounds._replace(effort=twice)._within_patience(plan)[0]
    assert able.tolist() == [True, False, True, True, False, True]
    # All steps of looks are waited for.
    looks = rounds._replace(looking=True)
    able, some = looks._within_patience(plan)
    assert able.all()
    assert some.segments.budget[1:] == pytest.approx(SETTINGS.patience)
    assert looks._waited(plan, found)[0] == 0.3 * SETTINGS.patience
