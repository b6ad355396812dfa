"""What is told of the plain system, on scenes that ship, against an effect switched off."""

import equinox as eqx
import jax
import numpy as np
import pytest
from outside_slips import states_outside_slips, times_about

import frictionjax as fx
from frictionjax.called_for.plain_system import _rest_of_tip
from frictionjax.io.example_scenes import example_lines, example_text
from frictionjax.io.scene_files import parse_scene
from frictionjax.model import BristlePotential

EPS = 5e-3
LEADING = (fx.effects.LeadingOrder(),)
SCENES = (
    *("vertical-spring", "slanted-spring", "angular-spring", "leading-order"),
    *("nap", "measured-groove"),
)
SLOW = pytest.mark.slow
CASES = [
    pytest.param(name, gamma, EPS, marks=() if (name, gamma) == (SCENES[0], 1.0) else SLOW)
    for name in SCENES
    for gamma in (0.5, 1.0, 2.0)
]
# Where slips are late by how far a fold moves, 20 times what its force says.
CASES.append(pytest.param("nap", 2.0, 2e-2, marks=SLOW))
# Wells so stiff that tips hardly move in them.
CASES += [pytest.param("crawler-foot", g, 5e-6, marks=SLOW) for g in (0.5, 1.0, 2.0)]
# Without effects of the state these are scenes that are among those above.
AGAIN = {
    "inertia": "vertical-spring",
    "axial-load": "angular-spring",
    "nap-flip": "nap",
}
NONE = "prandtl-tomlinson", "noise"  # homothetic bristles have no higher order
EVERY = (*SCENES, "crawler-foot", "rigid-array", "compliant-array")


def shipped_cells():
    """At all eps that ship, and at the largest and the smallest with other gammas."""
    for name in EVERY:
        study = parse_scene(example_text(name), name).study
        yield from ((name, study["gamma"][0], eps) for eps in study["eps"])
        ends = max(study["eps"]), min(study["eps"])
        yield from ((name, gamma, eps) for gamma in (0.5, 2.0) for eps in ends)


# A denser row of times than `explain` compares states at.
DENSE = 20_000


def change_outside_slips(scene, gamma, eps, count=4000):
    """Largest change of the state outside of slips, of a bristle of an array's own."""
    times = times_about(scene, eps, count)
    leading = scene.replace(effects=(*scene.effects, *LEADING))
    whole, calm = states_outside_slips(scene, gamma, eps, times)
    without, still = states_outside_slips(leading, gamma, eps, times)
    assert np.mean(calm & still) > 0.9
    return np.max(np.abs(whole - without)[calm & still])


def told_of(scene, gamma, eps):
    return float(fx.explain(scene, eps, gamma).effects.in_z.sel(effect="higher order"))


def each_bristle(scene):
    """Scenes of one bristle each, of a compliant array; of others the scene itself."""
    array = [e for e in scene.effects if isinstance(e, fx.effects.CompliantArray)]
    if not array:
        return [scene]
    alone = [fx.effects.CompliantArray([place]) for place in np.asarray(array[0].offsets)]
    return [scene.replace(effects=(one,)) for one in alone]


def scene_that_ships(name):
    """Without mass, noise and turning over."""
    scene = parse_scene(example_text(name), name).scene
    arrays = fx.effects.RigidArray, fx.effects.CompliantArray
    return scene.replace(effects=tuple(e for e in scene.effects if isinstance(e, arrays)))


@pytest.mark.parametrize(("name", "gamma", "eps"), CASES)
def test_the_higher_order_changes_less_than_told_and_no_tenth_of_it(name, gamma, eps):
    scene = scene_that_ships(name)
    seen = change_outside_slips(scene, gamma, eps)
    assert seen <= told_of(scene, gamma, eps) <= 10 * seen


@pytest.mark.slow
@pytest.mark.parametrize(("name", "gamma", "eps"), list(shipped_cells()))
def test_so_it_is_at_every_eps_that_ships(name, gamma, eps):
    scene = scene_that_ships(name)
    cases = each_bristle(scene)
    seen = max(change_outside_slips(one, gamma, eps, DENSE) for one in cases)
    assert seen <= told_of(scene, gamma, eps) <= 10 * seen


def test_no_scene_that_ships_is_left_out():
    assert {*EVERY, *AGAIN, *NONE} == set(example_lines())
    for name, other in AGAIN.items():
        assert eqx.tree_equal(scene_that_ships(name), scene_that_ships(other))


FLANKS = fx.profiles.Polyline([0.0, 0.7], [0.0, 0.06], radius=0.03)
UPRIGHT = fx.bristles.VerticalSpring(2.0, 3.0, 1.2)
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)


def on_straight_flanks(bristle, load):
    return fx.Scene(FLANKS, bristle, fx.supports.Spring(1.5), load, duration=2.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bristle", "load", "eps"),
    [
        (UPRIGHT, fx.loads.Ramp(1.0), 0.05),
        (UPRIGHT, fx.loads.Ramp(1.0), 1e-3),
        (UPRIGHT, fx.loads.Triangle(1.0, 2.0), 0.05),
        (SLANTED, fx.loads.Sine(1.0, 2.0), 0.05),
        (SLANTED, fx.loads.Triangle(1.0, 2.0), 1e-3),
    ],
)
def test_on_straight_flanks_the_higher_order_changes_less_than_told(bristle, load, eps):
    scene = on_straight_flanks(bristle, load)
    told = told_of(scene, 1.0, eps)
    assert change_outside_slips(scene, 1.0, eps) <= told


@pytest.mark.slow  # a surface of its own, through all that is explained
@pytest.mark.parametrize("eps", [0.05, 1e-3])
def test_on_straight_flanks_forces_change_by_what_the_higher_order_is(eps):
    """Of an upright spring `(F'(eps w) - F'(0)) w'`, though W''' is 0 at the folds."""
    places = (np.arange(4000) + 0.5) / 4000
    height, slope = FLANKS(places), jax.vmap(jax.grad(FLANKS))(places)
    pull = jax.vmap(jax.grad(UPRIGHT.energy))
    change = (pull(eps * height) - pull(0.0 * height)) * slope
    scene = on_straight_flanks(UPRIGHT, fx.loads.Ramp(1.0))
    row = fx.explain(scene, eps, 1.0).effects.sel(effect="higher order")
    # Slips that differ by more than the fall takes may be a well apart; seen: 0.004 eps.
    assert float(row.in_z) < 1.05 * eps
    assert float(row.in_force) == pytest.approx(float(np.max(np.abs(change))), rel=0.01)


@pytest.mark.parametrize("name", NONE)
def test_without_a_higher_order_nothing_is_told(name):
    assert told_of(scene_that_ships(name), 1.0, 0.1) == 0.0


@pytest.mark.parametrize(("eps", "within"), [(0.05, 2e-6), (1e-6, 2e-4)])
def test_a_rest_by_forces_is_that_by_its_definition(eps, within):
    """Central differences of Q and W, in phases of a tip that leans."""
    potential = BristlePotential(fx.profiles.Sine(0.1), SLANTED)
    phases, h = np.linspace(-0.5, 0.5, 24, endpoint=False), 1e-3
    found = _rest_of_tip(potential, np.asarray(eps), phases)
    rows = np.array([phases + k * h for k in (-2, -1, 0, 1, 2)])
    first, second = np.array([1, -8, 0, 8, -1]) / 12 / h, np.array([-1, 16, -30, 16, -1])
    third = np.array([-1, 2, 0, -2, 1]) / 2 / h**3
    rest, leading = potential.Q(eps, rows), potential.W(rows)
    second = second / 12 / h**2
    by_rows = first @ rest, second @ rest, second @ leading, third @ leading
    for mine, theirs, share in zip(found, by_rows, (1, 1, 1, 20), strict=True):
        np.testing.assert_allclose(
            mine, theirs, atol=share * within * np.max(np.abs(theirs))
        )


def far_apart(eps, gamma):
    """Two harmonics on a soft spring, pulled through thousands of wells."""
    sizes = np.array([0.0, 0.02 / np.pi]), np.array([0.05 / np.pi, 0.0])
    parts = fx.profiles.Fourier(*sizes), fx.bristles.VerticalSpring(1.0, 1.5, 1.0)
    amplitude = 3 * float(fx.friction(*parts).rho_plus) + 0.05 * eps * 30.37
    return fx.Scene(*parts, fx.supports.Spring(0.05), fx.loads.Ramp(amplitude), 1.0)


@pytest.mark.parametrize(("eps", "gamma", "seen"), [(1e-3, 1.5, 0.9915), (0.01, 2.0, 0.97)])
def test_a_slip_that_is_late_by_more_than_it_takes_is_a_well(eps, gamma, seen):
    """Of shares of a well that were measured, `seen` (at 0.01 by LSODA too)."""
    assert seen * eps <= told_of(far_apart(eps, gamma), gamma, eps) <= 1.2 * eps


@pytest.mark.slow
def test_tips_a_well_apart_are_seen():
    eps, gamma = 0.01, 2.0
    scene = far_apart(eps, gamma)
    well = 0.05 * eps / float(scene.load.rate)
    middle = 0.7 + well * np.linspace(0, 3, 1201)
    times = middle - 0.005 * well, middle, middle + 0.005 * well
    (whole, calm), (without, still) = (
        states_outside_slips(s, gamma, eps, times, 1e-5)
        for s in (scene, scene.replace(effects=LEADING))
    )
    seen = np.max(np.abs(whole - without)[calm & still])
    assert 0.9 * eps < seen <= told_of(scene, gamma, eps)
