"""Scenes as tables: what is compiled does not depend on who wrote the parts."""

import itertools
import re

import diffrax
import equinox as eqx
import jax
import numpy as np
import pytest
from at_places import at_places

import frictionjax as fx
from frictionjax._compile import Interpreted
from frictionjax.effects import Engine
from frictionjax.model import (
    coefficients,
    coefficients_jit,
    scene_for,
    scene_of_tables,
    tabulated,
    tabulated_scene,
)
from frictionjax.tables import PiecewiseProfile, SeriesBristle, SeriesProfile, Waves
from frictionjax.wiggly import limit_path
from frictionjax.wiggly.sequential.rosenbrock_solvers import Rodas5P

P, B, L = fx.profiles, fx.bristles, fx.loads
SLANTED = B.SlantedSpring(20.0, 1.3, 1.0, 0.3)
PROFILES = {
    "sine": P.Sine(0.2),
    "series": P.Fourier([0.02, 0.01, 0.0], [0.01, 0.0, 0.004]),
    "many waves": P.Fourier(np.zeros(71), 0.02 * 0.5 ** np.arange(71)),
    "spline": P.Spline(0.02 * np.sin(2 * np.pi * np.arange(12) / 12)),
    "polyline": P.Polyline([0.0, 0.5], [0.0, 0.04], 0.4),
}
BRISTLES = {
    "vertical": B.VerticalSpring(20.0, 1.3, 1.0),
    "slanted": SLANTED,
    "angular": B.AngularSpring(8.0, 1.3, 1.0, 0.1),
}
LOADS = {
    "sine": L.Sine(6.0, 2.0),
    "triangle": L.Triangle(6.0, 2.0),
    "ramp": L.Ramp(4.0),
    "points": L.PiecewiseLinear([0.0, 0.7, 1.5], [0.0, 6.0, -6.0]),
}


# Where it bends pieces are too short for a table.
BENT = L.Custom(lambda t: 6 * t + 0.1 * jax.numpy.abs(t - 0.777) ** 1.5)


def scene_of(profile="sine", bristle="vertical", load="sine"):
    spring = fx.supports.Spring(2.0)
    return fx.Scene(PROFILES[profile], BRISTLES[bristle], spring, LOADS[load], 2.0)


# Each pair is a program of its own for the parts as they are.
FEW = {("sine", "angular"), ("many waves", "slanted"), ("spline", "vertical")}
FEW |= {("series", "vertical"), ("polyline", "angular")}
PAIRS = [
    pytest.param(*pair, marks=() if pair in FEW else pytest.mark.slow)
    for pair in itertools.product(PROFILES, BRISTLES)
]


def test_scenes_of_few_waves_are_of_one_kind():
    """Whatever the bristle: a scene of another kind has nothing to compile."""
    kinds = set()
    for profile, bristle in itertools.product(("sine", "series"), BRISTLES):
        tables = tabulated_scene(scene_of(profile, bristle), 0.02)
        leaves, structure = jax.tree_util.tree_flatten(
            (tables.potential, tables.lane_potential)
        )
        kinds.add((structure, *(np.shape(leaf) for leaf in leaves)))
    assert len(kinds) == 1


coefficients_of_parts = Interpreted(coefficients)  # which compiles nothing


@pytest.mark.parametrize(("profile", "bristle"), PAIRS)
def test_coefficients_are_those_of_the_parts(profile, bristle):
    potential = fx.potential(PROFILES[profile], BRISTLES[bristle])
    found, expected = coefficients_jit(potential), coefficients_of_parts(potential)
    for name, value in vars(expected).items():
        if value is not None:
            assert float(getattr(found, name)) == pytest.approx(float(value), rel=1e-12)


@jax.jit
def forces_at(potential, y, eps):
    return jax.vmap(lambda place: potential.tip_force(place, eps))(y)


@pytest.mark.parametrize(("profile", "bristle"), PAIRS)
def test_forces_are_those_of_the_parts(profile, bristle):
    scene = scene_of(profile, bristle)
    tables = tabulated_scene(scene, [1e-3, 1e-2])
    y = np.linspace(-1, 1, 101)
    for potential in (tables.potential, tables.lane_potential):
        for eps in (1e-2, 1e-3, 1e-6):
            both = [forces_at(p, y, eps) for p in (potential, scene.potential)]
            for found, expected in zip(*both, strict=True):
                size = float(np.abs(expected).max())
                assert np.max(np.abs(np.asarray(found - expected))) < 1e-12 * size


def compiled(log):
    """Names of the programs of the library that JAX says it has compiled."""
    said = [re.search(r"compilation of jit\((\w+)\)", r.getMessage()) for r in log.records]
    names = {match[1] for match in said if match}
    # What JAX compiles for steps that it makes one by one has the name of the step.
    return {name for name in names if name.startswith("_") or name in ENGINE}


ENGINE = {"run_queue", "coefficients", "pull_between", "run_block"}


def test_scenes_of_all_classes_run_the_same_programs(caplog):
    """After one scene of each size, others compile nothing of the library."""

    def solved(*names):
        with jax.log_compiles(True):
            assert fx.solve(scene_of(*names), 1e-2, 1.0, [1.0, 2.0], dissipation=False).ok
        names = compiled(caplog)
        caplog.clear()
        return names

    def own_program(x):
        return x + 1.0

    with jax.log_compiles(True):  # which is seen, or the rest shows nothing
        own_program.__name__ = "run_queue"
        jax.jit(own_program)(1.0)
    assert compiled(caplog) == {"run_queue"}
    caplog.clear()
    solved("sine", "vertical", "sine")
    solved("polyline", "angular", "points")
    assert solved("sine", "slanted", "triangle") == set()
    assert solved("sine", "vertical", "ramp") == set()
    assert solved("spline", "angular", "points") == set()


def sine_by_hand(t):
    return 6 * jax.numpy.sin(3 * t)


def spring_by_hand(z):
    return z**2


def test_scenes_whose_loads_are_functions_are_of_one_kind():
    kinds = set()
    functions = sine_by_hand, (lambda t: 5 * t + t**2)
    scenes = [scene_of().replace(load=L.Custom(fn)) for fn in functions]
    for scene in scenes:
        tables = tabulated_scene(scene, 1e-2)
        leaves, structure = jax.tree_util.tree_flatten(tables._replace(turning_points=()))
        kinds.add((structure, *(np.shape(leaf) for leaf in leaves)))
        assert tables.untabulated == ""
    assert len(kinds) == 1


def test_supports_given_as_functions_are_of_one_kind():
    kinds = set()
    energies = spring_by_hand, (lambda z: z**2 + 0.01 * z**4)
    scenes = [scene_of().replace(support=fx.supports.Convex(fn)) for fn in energies]
    for scene in scenes:
        tables = tabulated_scene(scene, 1e-2)
        leaves, structure = jax.tree_util.tree_flatten(tables)
        kinds.add((structure, *(np.shape(leaf) for leaf in leaves)))
        assert tables.untabulated == ""
    assert len(kinds) == 1


def test_functions_are_solved_as_the_parts_that_they_are():
    """A load and a support at once: one loop for both."""
    parts = scene_of().replace(load=L.Sine(6.0, 2 * np.pi / 3))
    support = fx.supports.Convex(spring_by_hand)
    functions = parts.replace(load=L.Custom(sine_by_hand), support=support)
    ts = [0.5, 1.0, 2.0]
    both = [fx.solve(scene, 1e-2, 1.0, ts) for scene in (functions, parts)]
    assert all(each.ok for each in both)
    np.testing.assert_allclose(both[0].z, both[1].z, atol=1e-7 * 1e-2)
    np.testing.assert_allclose(both[0].dissipation, both[1].dissipation, rtol=1e-6)


def test_series_of_supports_reach_as_far_as_wiggles_at_this_eps_pull():
    """Where the bristle bends folds at large eps are higher than rho."""
    support = fx.supports.Convex(lambda z: z**2 + 0.01 * z**4)
    bent = B.Custom(lambda eta: 16 * eta**2, lambda eta: 20 * eta)
    scene = scene_of().replace(support=support, bristle=bent, profile=P.Sine(0.5))
    reached = []
    for eps in (1e-3, 1.0):
        tables = tabulated_scene(scene, eps)
        pulls = forces_at(tables.potential, np.linspace(0, 1, 401), eps)[0]
        least, most = -6.0 - float(pulls.max()), 6.0 - float(pulls.min())
        sides = tables.support.low, tables.support.high
        ends = [float(support.force(side)) for side in sides]
        assert ends[0] < least < most < ends[1]
        reached.append(ends[1] - ends[0])
    assert reached[1] > 1.1 * reached[0]


def test_supports_of_scenes_with_mass_stay_functions():
    support = fx.supports.Convex(lambda z: z**2 + 0.01 * z**4)
    inertia = fx.effects.Inertia(mass=1e-3, exponent=1.0)
    scene = scene_of().replace(support=support, effects=(inertia,))
    assert tabulated_scene(scene, 1e-2).support is scene.support


@pytest.mark.slow  # two programs of diffrax: 15 s
def test_solvers_of_diffrax_run_the_same_programs_for_all_classes(caplog):
    ts, method = np.linspace(0.0, 2.0, 61), Rodas5P()

    def solved(*names):
        scene = scene_of(*names)
        with jax.log_compiles(True):
            found = fx.solve(scene, 0.02, 1.0, ts, method=method, accuracy=1e-2)
            data = fx.sweep(scene, [0.02], [1.0], ts, method=method, accuracy=1e-2)
        assert found.ok
        # Compiled otherwise, steps may be others.
        np.testing.assert_allclose(data.z[0, 0], found.z, atol=1e-2 * 0.02)
        said = compiled(caplog) & {"_planned", "_forth", "run_block"}
        caplog.clear()
        return said

    assert len(solved("sine", "slanted", "sine")) == 3
    assert solved("series", "angular", "points") == set()
    assert solved("sine", "vertical", "ramp") == set()
    assert solved("series", "slanted", "triangle") == set()


@pytest.mark.slow  # a trajectory's program for the parts themselves: 9 s
def test_solvers_of_diffrax_find_what_they_find_on_the_parts():
    """Which an adjoint asks for."""
    ts, method = [0.0, 0.5, 2.0], Rodas5P()
    scene = scene_of("series", "slanted", "triangle")
    found = fx.solve(scene, 0.02, 1.0, ts, method=method, accuracy=1e-2)
    adjoint = diffrax.RecursiveCheckpointAdjoint()
    more = {"method": method, "accuracy": 1e-2, "adjoint": adjoint}
    parts = fx.solve(scene, 0.02, 1.0, ts, **more)
    np.testing.assert_allclose(found.z, parts.z, atol=1e-2 * 0.02)


def test_scenes_of_tables_are_the_scene():
    scene = scene_of("series", "angular", "triangle")
    tables = scene_of_tables(scene, [1e-2, 1e-3])
    t = np.linspace(0.0, 2.0, 41)
    np.testing.assert_allclose(
        at_places(tables.load, t), at_places(scene.load, t), atol=4e-15
    )
    turns = np.asarray(tables.turning_points())
    np.testing.assert_allclose(np.unique(turns), [0.5, 1.5, 2.0])
    assert float(tables.z0) == float(scene.z0)
    for eps in (1e-2, 1e-4):
        at_y = [
            forces_at(s.potential, np.linspace(-1, 1, 41), eps) for s in (tables, scene)
        ]
        for found, expected in zip(*at_y, strict=True):
            np.testing.assert_allclose(found, expected, atol=1e-12)


def test_scenes_of_tables_are_of_one_kind_at_any_eps():
    kinds = set()
    for bristle, load, eps in itertools.product(BRISTLES, LOADS, (1e-4, 0.1)):
        tables = scene_of_tables(scene_of("series", bristle, load), eps)
        leaves, structure = jax.tree_util.tree_flatten(tables)
        kinds.add((structure, *(np.shape(leaf) for leaf in leaves)))
    assert len(kinds) == 1


def test_sums_of_tips_are_a_surface_of_their_own_at_each_eps():
    array = fx.effects.RigidArray(offsets=[0.0, 0.3])
    scene = scene_for(Engine.PATH, scene_of().replace(effects=(array,)))
    assert scene_of_tables(scene, [1e-2, 1e-3]) is scene
    one = scene_of_tables(scene, [1e-2])
    y = np.linspace(-1, 1, 41)
    for found, expected in zip(
        *(forces_at(s.potential, y, 1e-2) for s in (one, scene)), strict=True
    ):
        np.testing.assert_allclose(found, expected, atol=1e-10)


OWN = scene_of().replace(
    profile=P.Custom(lambda y: 0.02 * jax.numpy.abs(jax.numpy.sin(np.pi * y)) ** 2.5),
    support=fx.supports.Convex(lambda z: z**2 + 0.01 * jax.numpy.abs(z) ** 3.5),
    load=BENT,
)
FEW_VALUES = {"ts": [1.0], "dissipation": False}


def values_told(scene):
    """What a sweep and a solution say that programs were compiled for."""
    data = fx.sweep(scene, [0.05], [1.0], suprema=False, **FEW_VALUES)
    found = fx.solve(scene, 0.05, 1.0, **FEW_VALUES)
    return data.attrs.get("compiled_for", ""), found.stats["values"]


def test_what_no_table_holds_is_told(monkeypatch):
    assert tabulated_scene(scene_of("spline", "angular"), 1e-2).untabulated == ""
    said = "support Convex, load Custom, profile Custom"
    assert tabulated_scene(OWN, 1e-2).untabulated == said
    of_sweep, of_solution = values_told(scene_of())
    assert of_sweep == ""
    assert "compiled for" not in of_solution
    # As if no table held a spring, whose programs are there.
    others = tuple(kind for kind in tabulated._KNOWN if kind is not fx.supports.Spring)
    monkeypatch.setattr(tabulated, "_KNOWN", others)
    of_sweep, of_solution = values_told(scene_of())
    assert of_sweep == "support Spring"
    assert of_solution.endswith("compiled for support Spring")


@pytest.mark.slow  # a loop for its parts; wiggly/test_trajectory.py runs one of a given W
def test_scenes_that_no_table_holds_go_through_lanes():
    said = "support Convex, load Custom, profile Custom"
    of_sweep, of_solution = values_told(OWN)
    assert of_sweep == said
    assert of_solution.endswith(f"compiled for {said}")


def wave(Y):
    return 0.3 * jax.numpy.sin(2 * np.pi * Y)


@eqx.filter_jit
def energies_and_forces(potential, y, eps):
    return [
        jax.vmap(lambda place, of=of: of(place, eps))(y)
        for of in (potential.tip_energy, potential.tip_force)
    ]


@pytest.mark.parametrize(
    "W",
    [wave, lambda Y: 0.1 + wave(Y) + 0.1 * jax.numpy.abs(wave(Y - 0.3)) ** 3],
    ids=["a series", "pieces"],
)
def test_a_given_w_is_a_table(W):
    given = fx.GivenPotential(W)
    parts = {"support": fx.supports.Spring(2.0), "load": LOADS["sine"], "duration": 2.0}
    scene = fx.Scene(potential=given, **parts)
    tables = tabulated_scene(scene, 1e-2)
    assert tables.untabulated == ""
    y = np.linspace(-2, 2, 401)
    for table in (tables.potential, tables.lane_potential):
        for eps in (1e-2, 1e-5):
            both = [energies_and_forces(of, y, np.asarray(eps)) for of in (table, given)]
            (energy, force), (expected_energy, expected_force) = both
            np.testing.assert_allclose(energy, expected_energy, rtol=0, atol=1e-14 * eps)
            np.testing.assert_allclose(force, expected_force, rtol=0, atol=1e-12)
    law = fx.friction(scene)
    slope = jax.jit(jax.vmap(jax.grad(W)))(np.linspace(0, 1, 4001))
    assert law.rho_plus == pytest.approx(float(slope.max()), rel=1e-6)


def test_a_given_w_with_q_is_not_and_has_the_friction_of_w():
    given = fx.GivenPotential(wave, lambda eps, Y: wave(Y) ** 2)
    parts = {"support": fx.supports.Spring(2.0), "load": LOADS["sine"], "duration": 2.0}
    scene = fx.Scene(potential=given, **parts)
    assert tabulated_scene(scene, 1e-2).untabulated == "potential GivenPotential"
    assert fx.friction(scene).rho_plus == pytest.approx(0.6 * np.pi, rel=1e-14)


@pytest.mark.parametrize("potential", [None, fx.GivenPotential(wave)])
def test_lanes_go_through_harmonics_and_plans_have_them_as_an_axis(potential):
    """The other way about a step takes half as long again."""
    scene = scene_of()
    if potential is not None:
        rest = {"support": scene.support, "load": scene.load, "duration": 2.0}
        scene = fx.Scene(potential=potential, **rest)
    tables = tabulated_scene(scene, 1e-2)
    assert type(tables.lane_potential.profile) is SeriesProfile
    assert type(tables.potential.profile) is Waves


def test_tables_are_kept_for_the_last_eps():
    scene = scene_of()
    assert tabulated_scene(scene, 1e-3) is tabulated_scene(scene, [1e-5, 1e-3])
    assert tabulated_scene(scene, 1e-2) is not tabulated_scene(scene, 1e-3)


def test_turning_points_and_rooms_for_them():
    scene = scene_of(load="triangle")
    np.testing.assert_allclose(tabulated_scene(scene, 1e-3).turning_points, [0.5, 1.5])
    path = limit_path.path_of(tabulated_scene(scene, 1e-3))
    np.testing.assert_allclose(path.edges, [0.0, 0.5, 1.5, 2.0])


def test_what_no_table_holds_is_compiled_for_itself():
    scene = scene_of().replace(load=BENT)
    assert tabulated_scene(scene, 1e-3).load is scene.load
    other = fx.GivenPotential(wave, lambda eps, Y: wave(Y) ** 2)
    tables = tabulated_scene(
        fx.Scene(potential=other, support=scene.support, load=LOADS["sine"], duration=2.0),
        1e-3,
    )
    assert tables.potential is other
    near = tabulated_scene(scene_of(bristle="angular"), 1e-3)
    assert isinstance(near.potential.bristle, SeriesBristle)
    assert isinstance(
        tabulated_scene(scene_of("spline"), 1e-3).potential.profile, PiecewiseProfile
    )
