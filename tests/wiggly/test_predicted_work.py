"""Work from the plan, before anything is integrated: steps, rows of tables."""

import tracemalloc

import numpy as np
import pytest
from flat_folds import SCENES
from foretold import TIMES, scene_of

import frictionjax as fx
from frictionjax._checks.grids import cells_of
from frictionjax.model import tabulated_scene
from frictionjax.wiggly.enclosure import BracketContext, lay_out, marching
from frictionjax.wiggly.limit_path import path_of
from frictionjax.wiggly.plan import planned
from frictionjax.wiggly.predicted_work import _longest_chains, _weight_of, workload
from frictionjax.wiggly.ways import Way


@pytest.mark.parametrize(
    ("eps", "gamma", "accuracy", "method"),
    [
        (5e-2, 1.0, 1e-3, "auto"),
        (1e-5, 1.0, 1e-3, "auto"),
        pytest.param(2e-3, 2.0, 1e-3, "auto", marks=pytest.mark.slow),
        pytest.param(1e-2, 1.0, 1e-5, "auto", marks=pytest.mark.slow),
        (5e-3, 1.0, 1e-3, "resolved"),
        (2e-3, 0.5, 1e-3, "auto"),
    ],
)
def test_the_work_is_foreseen(eps, gamma, accuracy, method):
    cell = np.array([eps]), np.array([gamma])
    work = workload(scene_of(), *cell, TIMES.size, accuracy, method)
    data = fx.sweep(scene_of(), *cell, TIMES, accuracy, method)
    ratio = float(data.steps.squeeze()) / float(work.steps[0])
    assert 0.5 < ratio < 2, ratio  # 0.57 to 1.4


@pytest.mark.parametrize(
    ("gamma", "eps"),
    [
        pytest.param(0.5, 1e-4, marks=pytest.mark.slow),
        pytest.param(1.0, 1e-6, marks=pytest.mark.slow),
        (2.0, 1e-7),
    ],
)
def test_the_work_on_straight_flanks_is_foreseen(gamma, eps):
    """Eleven times too much and ten times too little was said."""
    cell = np.array([eps]), np.array([gamma])
    work = workload(SCENES["sawtooth"], *cell, TIMES.size, 1e-3, "auto")
    data = fx.sweep(SCENES["sawtooth"], *cell, TIMES)
    assert 0.5 < data.steps.item() / float(work.steps[0]) < 2


_STEPPED = fx.loads.PiecewiseLinear(
    [0.0, 1.0, 1.001, 2.0, 2.001, 3.0], [0.0, 0.0, 1.0, 1.0, -1.0, -1.0]
)


@pytest.mark.parametrize(
    ("load", "duration", "eps", "gamma"),
    [
        (fx.loads.Sine(1.0488, 3.0), 30.0, 1e-3, 0.5),  # 21 slip maps, side by side
        (fx.loads.Sine(1.0488, 3.0), 30.0, 1e-2, 0.5),  # one lane through all
        (fx.loads.Sine(0.05, 3.0), 300.0, 1e-2, 1.0),  # never out of the strip
        # Slip maps one after the other: slides end at speed.
        pytest.param(
            fx.loads.Triangle(1.0488, 0.3), 3.0, 1e-3, 1.0, marks=pytest.mark.slow
        ),
        # Tips that follow only after a jump.
        pytest.param(_STEPPED, 3.0, 1e-3, 1.0, marks=pytest.mark.slow),
        pytest.param(_STEPPED, 3.0, 1e-3, 0.5, marks=pytest.mark.slow),
    ],
)
def test_the_work_of_other_loads_is_foreseen(load, duration, eps, gamma):
    """Up to 37 and 212 times too little was said."""
    one = scene_of(load)
    scene = fx.Scene(one.profile, one.bristle, one.support, load, duration)
    times = np.linspace(0, duration, 61)
    work = workload(scene, np.array([eps]), np.array([gamma]), 61, 1e-3, "auto")
    data = fx.sweep(scene, eps, gamma, times)
    ratio = data.steps.item() / float(work.steps[0])
    assert 0.4 < ratio < 2.5, ratio  # 0.49 to 0.81


@pytest.mark.parametrize(("gamma", "steps"), [(0.5, 2.31e5), (1.0, 1.04e5)])
def test_the_work_of_jumps_is_foreseen(gamma, steps):
    """Steps as the sweep reports them, see above."""
    cell = np.array([1e-3]), np.array([gamma])
    work = workload(scene_of(_STEPPED), *cell, 61, 1e-3, "auto")
    assert 0.4 < steps / float(work.steps[0]) < 2.5


def test_slip_maps_that_wait_for_each_other():
    slides = np.array([[1, 0, 1, 0, 1, 1], [1, 1, 1, 1, 0, 0], [0, 0, 0, 0, 0, 0]], bool)
    cut = np.array([[0, 1, 0, 0, 0, 0], [1, 1, 1, 1, 1, 1], [0, 0, 0, 0, 0, 0]], bool)
    assert _longest_chains(slides, cut).tolist() == [3, 1, 0]


@pytest.mark.parametrize(("periods", "alone"), [(1, False), (3, True), (100, True)])
def test_many_short_slides_are_no_matter_for_slip_maps(periods, alone):
    """100 periods of 380 wells took 14 s by maps, one lane goes through them in 3."""
    one = scene_of()
    end = 3.0 * periods
    scene = fx.Scene(one.profile, one.bristle, one.support, one.load, end)
    eps = np.array([1.5e-3 if periods == 1 else 1e-2])
    tables = tabulated_scene(scene, eps)
    plan = planned(
        tables, path_of(tables), eps, np.array([0.5]), 61, accuracy=1e-3, method="auto"
    )
    assert plan.way == (Way.ONE_LANE if alone else Way.SLIP_MAP)


@pytest.mark.parametrize(
    ("eps", "gamma", "times", "method"),
    [
        pytest.param(
            *([5e-2, 1e-2, 1e-3], [1.0, 2.0], 401, "auto"), marks=pytest.mark.slow
        ),
        ([1e-5], [1.0], 401, "auto"),
        ([1e-3], [1.0], 2001, "resolved"),
    ],
)
def test_the_rows_of_tables_are_foreseen(monkeypatch, eps, gamma, times, method):
    rows, plans = np.zeros(2), marching.plan_brackets

    def plan(*parts):
        found = plans(*parts)
        rows[:] += found.jobs.cell.size, found.segments.start.size
        return found

    monkeypatch.setattr(marching, "plan_brackets", plan)
    cells = cells_of(np.array(eps), np.array(gamma))
    work = workload(scene_of(), *cells, times, 1e-3, method)
    fx.sweep(scene_of(), eps, gamma, np.linspace(0.0, 3.0, times), 1e-3, method)
    ratios = rows / (work.jobs.sum(), work.segments.sum())
    assert np.all((ratios > 0.7) & (ratios < 1.3)), ratios


@pytest.mark.parametrize(("eps", "gamma"), [(1e-7, 0.25), (1e-5, 0.5)])
def test_rows_of_lanes_beside_slip_maps_are_foreseen(monkeypatch, eps, gamma):
    """As many as through all wells between, 3 GB of them, were foretold for 5 MB."""
    rows, plans = [], marching.plan_brackets

    def plan(*parts):
        found = plans(*parts)
        rows.append(found.segments.start.size)
        return found

    monkeypatch.setattr(marching, "plan_brackets", plan)
    work = workload(scene_of(), np.array([eps]), np.array([gamma]), 2, 1e-3, "auto")
    assert work.maps.sum() > 0
    fx.sweep(scene_of(), eps, gamma, [0.0, 3.0])
    assert 0.2 < max(rows) / work.segments.sum() < 2


def test_tables_grow_with_the_times_and_not_their_square():
    """The layout of 20 001 times took 0.4 GB, of 200 001 it failed."""
    cell = np.array([1e-3]), np.array([1.0])
    scene = tabulated_scene(scene_of(), 1e-3)
    path = path_of(scene)
    ts = np.sort(np.concatenate([np.linspace(0.0, 3.0, 20_000), [1.5, 1.5]]))
    plan = planned(scene, path, *cell, ts.size, accuracy=1e-3, method="resolved")
    tracemalloc.start()
    blank = BracketContext(*[None] * 11)
    rounds = blank._replace(path=path, ground=plan.ground, accuracy=1e-3)
    found = lay_out(rounds, ts, plan.needs)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 1000 * ts.size, most / ts.size
    at = found.output[0]
    assert np.all(found.brackets.stop[at[1:]] == ts[1:])
    assert at[0] == -1  # the start is known


def test_work_follows_from_the_numbers():
    grid = np.array([1e-3, 1e-4]), np.array([1.0, 1.0])
    every = workload(scene_of(), *grid, TIMES.size, 1e-3, "resolved")
    assert every.steps[1] == pytest.approx(10 * every.steps[0], rel=0.5)
    small = np.array([1e-5, 1e-7]), np.array([1.0, 1.0])
    some = workload(scene_of(), *small, TIMES.size, 1e-3, "windowed")
    assert some.steps[1] < 2 * some.steps[0]
    waves = fx.profiles.Fourier(np.zeros(16), 0.005 * 0.5 ** np.arange(16))
    parts = scene_of()
    bumpy = fx.Scene(waves, parts.bristle, parts.support, parts.load, 3.0)
    weights = [_weight_of(tabulated_scene(scene, 1e-3)) for scene in (bumpy, parts)]
    assert weights[0] > 1.2 * weights[1]  # 0.21 us a step in pieces, 0.16 of a sine
