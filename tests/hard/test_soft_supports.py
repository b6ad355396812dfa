"""Supports a hundred to 1e5 times softer than wells: tips stay a second behind the path."""

from types import SimpleNamespace

import numpy as np
import pytest
from paths import path_of

import frictionjax as fx
from frictionjax.model import tabulated_scene
from frictionjax.wiggly import batch
from frictionjax.wiggly.attempts import SoFar
from frictionjax.wiggly.enclosure import SETTINGS, marching
from frictionjax.wiggly.plan import planned
from frictionjax.wiggly.settings import SETTINGS as WAYS
from frictionjax.wiggly.sums import nothing_found
from frictionjax.wiggly.ways import Way

BRISTLE = fx.bristles.SlantedSpring(stiffness=1.0, rest_length=2.4, height=1.0, angle=1.0)
LOADS = {"sine": fx.loads.Sine(1.05, 3.0), "triangle": fx.loads.Triangle(1.05, 1.5)}


def scene_on(stiffness, load="sine"):
    """Lengths in m, forces in N."""
    support = fx.supports.Spring(stiffness)
    return fx.Scene(fx.profiles.Sine(0.1), BRISTLE, support, LOADS[load], 3.0)


def plan_of(scene, eps, gamma):
    cell = np.array([eps]), np.array([gamma])
    return planned(tabulated_scene(scene, eps), path_of(scene), *cell, 61, 1e-3, "auto")


@pytest.mark.filterwarnings("ignore:1 of .* cells failed")
def test_what_no_lane_can_go_through_ends_beside_other_scenes(monkeypatch):
    """1.4e9 wells that no map knows: they were laid out, for hours, and held up all others.

    Lanes look for less than five seconds here.
    """
    short = marching.SETTINGS._replace(patience=1e5)
    monkeypatch.setattr(marching, "SETTINGS", short)
    eps, gamma = 1e-5, 0.5
    soft, usual = scene_on(3e-4, "triangle"), scene_on(1.0, "triangle")
    both = fx.sweep([soft, usual], [eps], gamma)
    alone = fx.sweep(usual, [eps], gamma)
    ended = fx.Status.OPEN_BRACKET, fx.Status.OK
    assert both.status.values.ravel().tolist() == [int(status) for status in ended]
    assert np.isnan(both.z.values[0]).all()
    assert both.steps.values[0] < 1e6
    assert (both.z.values[1] == alone.z.values).all()
    assert both.sup_error.values[1] == alone.sup_error.values


@pytest.mark.parametrize(
    ("stiffness", "eps", "gamma", "way"),
    [
        # 2.0e5 and 6.8e5 wells of the path: more than one lane was let through.
        (6.4e-4, 0.028, 0.5, Way.ONE_LANE),
        (2e-4, 0.027, 1.0, Way.ONE_LANE),
        # Tips follow within a hundredth of a second: 3.7e8 wells.
        (1e-3, 1e-5, 1.0, Way.SLIP_MAP),
    ],
)
def test_one_lane_goes_through_where_tips_stay_far_behind(stiffness, eps, gamma, way):
    """And its stops are as much further apart as it may go further."""
    scene = scene_on(stiffness)
    plan, alone = plan_of(scene, eps, gamma), way == Way.ONE_LANE
    assert plan.way.item() == way
    assert (plan.needs.leg.item() > SETTINGS.most_wells_a_leg) == alone
    assert (plan.ground.affordable.item() > SETTINGS.affordable) == alone
    found = fx.solve(scene, eps, gamma, np.linspace(0.0, 3.0, 24))
    assert found.status == fx.Status.OK
    assert found.stats["bracket"].max() < 1e-3


@pytest.mark.slow
def test_such_a_lane_is_where_another_solver_is():
    scene, ts = scene_on(6.4e-4), np.linspace(0.01, 3.0, 24)
    found = fx.solve(scene, 0.028, 0.5, ts)
    known = fx.solve(scene, 0.028, 0.5, ts, 1e-4, "Kvaerno5")
    assert known.ok
    assert np.abs(np.asarray(found.z - known.z)).max() < 1e-6 * 0.028


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:1 of .* cells failed")
@pytest.mark.parametrize(
    ("stiffness", "eps", "steps"), [(1e-3, 1e-3, 8e6), (1e-4, 1e-5, 6e7), (1e-3, 1e-2, 4e6)]
)
def test_cells_of_which_starts_are_not_forgotten_end_within_seconds(stiffness, eps, steps):
    """6.4e7 steps in 59 s; no end within three minutes; open after 1.3 s."""
    data = fx.sweep(scene_on(stiffness), [eps], 1.0)
    assert data.steps.item() < steps
    assert data.status.item() == (fx.Status.OK if eps == 1e-2 else fx.Status.OPEN_BRACKET)


@pytest.mark.parametrize(
    ("amplitude", "affordable"),
    [(500.0, True), (5e3, False)],  # 2.0e5 and 2.0e6 wells
)
def test_tips_that_follow_go_through_every_well(amplitude, affordable):
    """One lane was let through 2e6 wells at 500 times friction: it had no end."""
    load = fx.loads.Sine(amplitude, 3.0)
    scene = fx.Scene(fx.profiles.Sine(0.1), BRISTLE, fx.supports.Spring(1.0), load, 3.0)
    ground = plan_of(scene, 0.01, 1.0).ground
    assert ground.is_affordable(path_of(scene)).item() == affordable


@pytest.mark.filterwarnings("ignore:1 of .* cells failed")
def test_fast_tips_of_which_brackets_stay_open_end():
    load = fx.loads.Sine(5e3, 3.0)
    scene = fx.Scene(fx.profiles.Sine(0.1), BRISTLE, fx.supports.Spring(1.0), load, 3.0)
    data = fx.sweep(scene, [0.01], 1.0)
    assert data.status.item() == fx.Status.OPEN_BRACKET
    assert data.steps.item() < 1e6


@pytest.mark.parametrize("alone", [True, False])
def test_where_no_more_slips_can_be_sampled_one_lane_goes_if_it_may(alone):
    """With more wells than tiles go through; else the status says that it is rough."""
    scene, eps, gamma = scene_on(2e-4), np.array([0.027]), np.array([1.0])
    cells = batch._cells_of(plan_of(scene, eps[0], gamma[0]), eps, gamma)
    samples = np.array([WAYS.most_nodes])
    cells = cells._replace(needs=cells.needs._replace(samples=samples))
    if not alone:
        usual = cells.ground._replace(affordable=np.array([SETTINGS.affordable]))
        cells = cells._replace(ground=usual)
    known = SoFar(cells, nothing_found(1, 2), np.array([False]))
    known = known.with_status(np.array([0]), fx.Status.OK)
    sweep = SimpleNamespace(rounds=SimpleNamespace(path=path_of(scene)))
    found = batch._surveyed_again(sweep, known, np.array([0]))
    assert found.open_.tolist() == [alone]
    ended = fx.Status.OK if alone else fx.Status.ROUGH_SURVEY
    assert found.answers.status.tolist() == [int(ended)]
