"""Which way cells go, from numbers alone."""

from types import SimpleNamespace

import numpy as np
import pytest
from paths import path_of

import frictionjax as fx
from frictionjax.wiggly.enclosure import SETTINGS, CellBounds, Requirements
from frictionjax.wiggly.lane_steps import affordable_wells
from frictionjax.wiggly.ways import Way, by_brackets, ways_of

SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.0488, 3.0),
    3.0,
)
EPS = np.array([1e-2, 1e-4, 1e-6])


def needs_of(path, run_up):
    one, pieces = np.ones(EPS.size), (EPS.size, path.direction.size)
    return Requirements(
        run_up=run_up * one,
        transient=(run_up + 3) * one,
        tile=3 * run_up * one,
        share=np.ones(pieces),
        samples=0 * one,
        lattice_offset=np.zeros(pieces),
        restarts=np.zeros(pieces, dtype=bool),
        settles=np.zeros(EPS.size, dtype=bool),
        leg=one,
    )


def chosen(run_up, method, follows=0.0, times=61):
    path = path_of(SCENE)
    needs, one = needs_of(path, run_up), np.ones(EPS.size)
    brackets = by_brackets(path, EPS, needs, times, method)
    none = dict.fromkeys(CellBounds._fields, None)
    ground = CellBounds(**none | {"eps": EPS, "affordable": SETTINGS.affordable * one})
    rest = needs, 0.125 * one, follows * one, brackets, method
    return ways_of(path, ground, *rest).tolist()


@pytest.mark.parametrize(
    ("method", "ways"),
    [
        ("auto", [Way.EVERY_SLIP, Way.SAMPLED, Way.SAMPLED]),
        ("windowed", [Way.SAMPLED] * 3),
        ("resolved", [Way.EVERY_SLIP] * 3),
    ],
)
def test_brackets_serve_where_little_is_remembered(method, ways):
    assert chosen(5.0, method) == ways


@pytest.mark.parametrize(
    ("method", "ways"),
    [
        ("auto", [Way.ONE_LANE, Way.SLIP_MAP, Way.SLIP_MAP]),
        ("windowed", [Way.SLIP_MAP] * 3),
        ("resolved", [Way.EVERY_SLIP] * 3),
    ],
)
def test_slip_maps_and_one_lane_serve_where_much_is(method, ways):
    assert chosen(2 * SETTINGS.long_memory, method) == ways


def test_one_lane_may_go_further_where_drags_are_larger_than_friction():
    """Never less far, and as usual where nothing is foretold."""
    lag, tolerance = np.array([0.1, 10.0, 1e6, 1e6, 1e6, 0.0]), 1e-6
    drag = np.array([0.0, 0.5, 1.0, 100.0, np.inf, np.nan])
    control = SimpleNamespace(tolerance=tolerance, reach=0.125)
    with np.errstate(all="ignore"):
        found = affordable_wells(control, lag, drag, 0.0 * lag) / SETTINGS.affordable
        all_wells = affordable_wells(control, lag, drag, 0.0 * lag + 1.0)
        all_wells /= SETTINGS.affordable
    assert found[[0, 1, 2, 4, 5]].tolist() == [1.0] * 5
    assert 5 < found[3] < 100
    assert 1 <= all_wells[3] < 2  # about as through any others


def test_one_lane_goes_where_slides_end_before_tips_follow():
    """As far as a lane can go: the last cell has millions of wells."""
    ways = [Way.ONE_LANE, Way.ONE_LANE, Way.SLIP_MAP]
    assert chosen(2 * SETTINGS.long_memory, "auto", follows=10.0) == ways
