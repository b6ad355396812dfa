"""Where lanes set off: below and above the tip, and near enough to it."""

import equinox as eqx
import jax
import numpy as np
import pytest
from landings_unknown import without_landings
from paths import path_of
from reference import System, sine
from reference import solve as solve_plainly
from windowed_scenes import SCENES, TIMES, cells, outside_slips, scene_of

import frictionjax as fx
from frictionjax.model import tabulated_scene
from frictionjax.numerics import rows_of
from frictionjax.wiggly import plan as planning
from frictionjax.wiggly import ways
from frictionjax.wiggly.enclosure import requirements
from frictionjax.wiggly.enclosure.starts import starts_of


@pytest.mark.parametrize("name", ["sine load", "several folds", "convex support"])
@pytest.mark.parametrize("eps", [1e-5, 1e-6])
def test_lanes_that_set_off_in_the_tips_well_find_the_same_in_fewer_steps(name, eps):
    scene, options = SCENES[name], {"balanced": False, "suprema": False}
    shift = 1e-3 * eps / path_of(scene).speed
    around = np.unique(np.clip(np.add.outer(TIMES, shift * np.array([-1, 0, 1])), 0, 3))
    near = cells(scene, eps, 1.0, "windowed", times=TIMES, **options)
    with without_landings():
        alone = cells(scene, eps, 1.0, "windowed", times=TIMES, **options)
        far = cells(scene, eps, 1.0, "windowed", times=around, **options)
    assert near.status == alone.status == far.status == fx.Status.OK
    assert near.steps.sum() < 0.65 * alone.steps.sum()
    first = np.searchsorted(around, np.maximum(TIMES - shift, 0.0))
    last = np.searchsorted(around, np.minimum(TIMES + shift, 3.0))
    low, high = np.sort([far.z[0][first], far.z[0][last]], axis=0)
    assert np.all(near.z[0] > low - 1e-3 * eps)
    assert np.all(near.z[0] < high + 1e-3 * eps)


def test_lanes_that_one_leaves_alone_have_met_ten_times_as_closely(monkeypatch):
    """As what is left is not looked at again: others set off from further back."""
    wanted = SCENES["sine load"], 1e-3, 1.0, "windowed"
    options = {"balanced": False, "suprema": False}
    plain = cells(*wanted, **options)
    hasty = requirements.SETTINGS._replace(slips_forget=0.0)
    monkeypatch.setattr(requirements, "SETTINGS", hasty)
    found = cells(*wanted, **options)
    assert found.status == fx.Status.OK
    assert found.steps > 1.2 * plain.steps
    assert found.gap.max() <= 0.1 * 1e-3


@eqx.filter_jit  # potentials of one kind share a program
def offsets(potential, tips, eps):
    return jax.vmap(lambda y: potential.offset(y, eps))(tips)


@pytest.mark.parametrize("name", ["sine load", "several folds", "convex support"])
@pytest.mark.parametrize("gamma", [1.0, 2.0, 3.0])
def test_lanes_set_off_below_and_above_the_tip(name, gamma):
    """At any moment of a slide, less than two wells apart where slips are over in time."""
    scene, eps = SCENES[name], {1.0: 3e-4, 2.0: 3e-3, 3.0: 3e-2}[gamma]
    tables, path, cell = tabulated_scene(scene, eps), path_of(scene), np.zeros(200, int)
    begin = np.random.default_rng(1).uniform(0.0, 3.0, cell.size)
    plan = planning.planned(
        tables, path, np.array([eps]), np.array([gamma]), 31, 1e-3, "auto"
    )
    none = np.zeros(cell.size)
    starts = starts_of(path, plan.ground, cell, begin, none, none)
    time, which = np.unique(starts.time, return_inverse=True)
    with without_landings():
        solution = fx.solve(scene, eps, gamma, time, 1e-5)
    assert solution.ok
    z = np.asarray(solution.z)[which]

    def states(well, tip):
        return eps * (well + tip) + offsets(tables.potential, tip, np.asarray(eps))

    behind = states(starts.behind_well, starts.behind_tip)
    ahead = states(starts.ahead_well, starts.ahead_tip)
    side = path.direction[path.piece_of(starts.time)]
    moves = ~starts.known_start
    assert moves.sum() > 100
    assert np.all(side * (z - behind) >= 0, where=moves)
    assert np.all(side * (ahead - z) >= 0, where=moves)
    width = (side * (ahead - behind) / eps)[moves]
    assert np.quantile(width, 0.9) < 1.75  # half a well to a well and a half


@pytest.mark.parametrize("gamma", [1.0, 2.0])
def test_lanes_that_set_off_at_rest_find_the_same_in_fewer_steps(gamma, monkeypatch):
    scene, eps = scene_of(), [1e-3, 7e-4]
    gammas = [gamma] * 2
    near = cells(scene, eps, gammas, "windowed")
    none = requirements.SETTINGS._replace(short_rest=np.inf)
    monkeypatch.setattr(requirements, "SETTINGS", none)
    with without_landings():
        far = cells(scene, eps, gammas, "windowed")
    assert near.steps.sum() < 0.6 * far.steps.sum()
    for i, e in enumerate(eps):
        _, counted = outside_slips(scene, e, gamma)
        assert counted.sum() > 20
        assert np.abs(near.z[i] - far.z[i])[counted].max() < 1e-3 * e
    assert np.allclose(near.sup_error, far.sup_error, rtol=0, atol=1e-3 * np.array(eps))
    assert near.gap.max() < 1e-3


def test_brackets_hold_the_tip():
    """Lanes set off below and above every trajectory that there is."""
    scene, eps, gamma = scene_of(), 2e-3, 1.0
    path = path_of(scene)
    control, start = planning._controls(
        tabulated_scene(scene, eps), path, np.full(64, eps), np.full(64, gamma), 1e-3
    )
    control, start = rows_of((control, start), slice(1))
    tables = tabulated_scene(scene, eps)
    ground = planning.ground_of(
        tables, path, np.array([eps]), np.array([gamma]), control, start
    )
    begin = np.linspace(0.1, 2.9, 200)
    far = np.full(200, 3.0)
    starts = starts_of(path, ground, np.zeros(200, int), begin, far, far)
    slides = np.flatnonzero(~starts.known_start)
    assert slides.size > 150
    time = np.unique(starts.time[slides])
    truth = cells(scene, eps, gamma, "resolved", times=time, balanced=False).z[0]
    z = truth[np.searchsorted(time, starts.time[slides])] / eps
    ends = np.stack(
        [starts.behind_well + starts.behind_tip, starts.ahead_well + starts.ahead_tip]
    )[:, slides]
    assert np.all(ends.min(axis=0) <= z)
    assert np.all(z <= ends.max(axis=0))
    assert np.ptp(ends, axis=0).max() < 5  # and not far away


def test_memory_is_that_of_the_flatter_fold(monkeypatch):
    # From the sharper one, brackets of this slide stayed open and 1.3e6 steps were taken.
    waves = fx.profiles.Fourier([0.004, -0.002, 0.0, 0.0005], [0.008, 0.003, -0.001, 0.0])
    rod, base = fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2), scene_of()
    scene = fx.Scene(waves, rod, base.support, base.load, 3.0)
    never = ways.SETTINGS._replace(far_back=np.inf)  # brackets, not slip maps
    monkeypatch.setattr(ways, "SETTINGS", never)
    data = fx.sweep(scene, 5.6e-4, 0.75, TIMES).squeeze()
    assert int(data.status) == 0
    assert float(data.steps) < 6e5
    assert np.all(data.how[3:] == 1)


@pytest.mark.slow
@pytest.mark.parametrize("z0", [-0.5, 0.5])
def test_a_far_start_is_not_forgotten_before_it_has_relaxed(z0):
    """While z0 comes back to the strip, brackets around its edge do not hold it."""
    times, eps, gamma = np.linspace(0.0, 0.3, 91), 1.1e-3, 0.8
    plain = System(
        sine(0.1),
        lambda eta: (0.0, 0.0, 1.0 + eta),
        lambda z: z,
        lambda t: 1.0488 * np.sin(2 * np.pi * t / 3),
        3.0,
    )
    truth = solve_plainly(plain, eps, gamma, z0, times)
    found = fx.solve(scene_of(z0=z0), eps, gamma, times, method="windowed")
    error = np.abs(np.asarray(found.z) - truth.z)
    assert np.max(error[~truth.in_slip]) < 1e-3 * eps
    assert found.ok


def test_tips_of_a_slide_that_is_let_go_again_and_again_land_late():
    """Each time they fall back, and the path does not: values were a well off, with OK."""
    eps, speed, level = 1e-3, 1.29, 0.11098
    time, load = [0.0, level / speed], [0.0, level]
    while level < 0.1 + 12.5 * eps:
        step = 0.06 * eps / speed
        time += [time[-1] + share * step for share in (0.01, 0.02, 1.02)]
        load += [level - 0.08, level, level + 0.06 * eps]
        level = load[-1]
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.PiecewiseLinear(time, load),
        time[-1],
        -0.35 * eps,
    )
    found = cells(scene, eps, 1.0, "auto", times=np.array(time))
    with without_landings():
        far = cells(scene, eps, 1.0, "auto", times=np.array(time))
    assert found.status == far.status == fx.Status.OK
    assert np.sum(found.how == 1) > 20
    assert np.abs(found.z - far.z).max() < 1e-3 * eps
