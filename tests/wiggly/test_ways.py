"""Which way cells go, from numbers alone."""

from types import SimpleNamespace

import numpy as np
import pytest
from paths import path_of

import frictionjax as fx
from frictionjax.wiggly import lane_steps
from frictionjax.wiggly.enclosure import SETTINGS, CellBounds, Requirements
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


@pytest.mark.parametrize(("share", "most"), [(0.0, 100.0), (1.0, 5.0)])
def test_one_lane_may_go_further_where_drags_are_larger_than_friction(
    monkeypatch, share, most
):
    """Never less far; as usual where nothing is foretold, or tips do not stay behind."""
    lag = np.array([0.1, 10.0, 1e6, 1e6, 1e6, 0.0])
    drag = [0.0, 0.5, 1.0, 100.0, np.inf, np.nan]
    monkeypatch.setattr(lane_steps, "drag_of", lambda *cells: np.array(drag))
    monkeypatch.setattr(lane_steps, "tip_share", lambda *cells: share)
    control = SimpleNamespace(tolerance=1e-6, reach=0.125)
    with np.errstate(all="ignore"):
        path, one = SimpleNamespace(stiffest=1.0), np.ones(lag.size)
        found = lane_steps.affordable_wells(path, control, lag, one, one)
    assert found[[0, 1, 2, 4, 5]].tolist() == [SETTINGS.affordable] * 5
    assert most / 20 <= found[3] / SETTINGS.affordable < most


@pytest.mark.parametrize("follows", [0.1, 0.5, 3.0, 100.0])
def test_tips_go_as_far_as_they_come_before_the_path_turns(follows):
    """A triangle of twelve ways in 3 s, by small steps."""
    edges, states = np.linspace(0, 3, 13), np.arange(13.0) % 2
    path = SimpleNamespace(edges=edges, states=states, travel=np.arange(13.0))
    found = lane_steps.tip_share(path, follows)
    times = np.linspace(0, 3, 30_001)
    tip, way, share = 0.0, 0.0, 1e-4 / follows
    for place in np.interp(times, edges, states):
        way, tip = way + share * abs(place - tip), tip + share * (place - tip)
    assert found == pytest.approx(way / 12, rel=0.05)


def test_tips_do_not_follow_a_jump():
    """However short it is, for what a tip takes to; then they go on their way."""
    edges, states = np.array([0.0, 1.0, 1.0 + 1e-12, 2.0]), np.array([0.0, 0.0, 1.0, 1.0])
    path = SimpleNamespace(edges=edges, states=states, travel=np.array([0.0, 0, 1, 1]))
    assert lane_steps.tip_share(path, 1e5) == pytest.approx(1e-5, rel=1e-4)
    assert lane_steps.tip_share(path, 0.1) == pytest.approx(1.0, rel=1e-4)


def test_one_lane_goes_where_slides_end_before_tips_follow():
    """As far as a lane can go: the last cell has millions of wells."""
    ways = [Way.ONE_LANE, Way.ONE_LANE, Way.SLIP_MAP]
    assert chosen(2 * SETTINGS.long_memory, "auto", follows=10.0) == ways
