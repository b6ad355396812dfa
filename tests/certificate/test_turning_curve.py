"""Curves of rods that turn over: accepted where every stretch and turn is a solution's."""

from functools import cache

import jax.numpy as jnp
import numpy as np
import pytest
from at_places import part_at
from rods_that_turn import REACH, jumping_scene, sampled, turning_scene
from turning_by_scipy import EPS as SCIPY_EPS
from turning_by_scipy import GAMMA as SCIPY_GAMMA
from turning_by_scipy import Independent, scipy_scene

import frictionjax as fx
from frictionjax.certificate.critical_places import RodSide
from frictionjax.turning import SceneParts, flipping_rod
from frictionjax.wiggly.turning import hybrid_motion

EPS, GAMMA, GAP = 0.03, 1.0, 5e-4
SCENES = {"led": turning_scene(), "jumps": jumping_scene()}
both = pytest.mark.parametrize("name", SCENES)
# Each scene and each sign once in every run, all pairs of them in the slow one.
SHIFTS = [("led", 0.1), ("jumps", -0.1)]
MORE_SHIFTS = [("led", -0.1), ("jumps", 0.1)]
SLOW_SHIFTS = [pytest.param(*pair, marks=pytest.mark.slow) for pair in MORE_SHIFTS]


@cache
def by_library(name):
    return sampled(SCENES[name], EPS, GAMMA, gap=GAP)


def turned_once(name):
    """Of it, until a while after the first turn: what is wrong there is wrong of all."""
    ts, z, mode = by_library(name)
    rows = slice(first_turn(mode)[1] + 500)
    return ts[rows], z[rows], mode[rows]


@cache
def accepted(name):
    return certified(name, *by_library(name))


@cache
def by_scipy(guard=1.0):
    told = np.array(Independent(guard).run(2.6))
    first = np.append(True, np.diff(told[:, 0]) > 0)
    ts, root, mode = told[first].T
    return ts, root - Independent.reach, mode.astype(int)


def certified(name, ts, z, mode, *, gamma=GAMMA, eps=EPS, root=None, scene=None):
    root = z + REACH if root is None else root
    scene = SCENES[name] if scene is None else scene
    return fx.certify(scene, eps, gamma, ts, z, root=root, mode=mode)


def by_scipy_certified(guard=1.0):
    known = {"scene": scipy_scene(), "eps": SCIPY_EPS, "gamma": SCIPY_GAMMA}
    return certified("", *by_scipy(guard), **known)


def turned_at(factor, monkeypatch, scene):
    """The library's curve of a rod that turns over at so much of its critical load."""
    right = hybrid_motion.flipping_rod

    def wrong(scene, effect):
        law = right(scene, effect)
        return law._replace(critical=factor * law.critical)

    with monkeypatch.context() as patch:
        patch.setattr(hybrid_motion, "flipping_rod", wrong)
        return sampled(scene, EPS, GAMMA, gap=GAP)


def standing_rod(scene):
    law = flipping_rod(scene, scene.effects[0])
    parts = SceneParts(
        profile=scene.profile,
        rod=scene.bristle,
        support=scene.support,
        load=scene.load,
        reach=jnp.asarray(law.reach),
        critical=jnp.asarray(law.critical),
    )
    return RodSide.of(parts, 1, EPS)


def first_turn(mode):
    """The last sample before it, and the last one of it."""
    between = np.flatnonzero(mode == 0)
    return int(between[0]) - 1, int(np.flatnonzero(np.diff(mode) * (mode[:-1] == 0))[0])


@both
def test_curves_of_the_library_are_accepted(name):
    mode = by_library(name)[2]
    found = accepted(name)
    assert found.ok, found
    assert {1, 0, -1} == set(mode.tolist())
    assert found.distance < 2e-3
    assert found.slips > 60
    assert found.skipped == 0
    assert abs(found.viscosity - 1) < 1e-3


@pytest.mark.slow
def test_what_solve_gives_is_accepted():
    """Until it has turned over once."""
    ts, _, mode = by_library("led")
    last, end = first_turn(mode)
    ts = np.union1d(ts[: end + 500], ts[last] + np.linspace(-1e-3, 1e-3, 21))
    solved = fx.solve(SCENES["led"], EPS, GAMMA, ts)
    args = {"root": solved.root, "mode": solved.mode}
    assert set(np.asarray(solved.mode).tolist()) == {1, 0, -1}
    found = fx.certify(SCENES["led"], EPS, GAMMA, solved.ts, solved.z, **args)
    assert found.ok, found
    assert found.distance < 2e-3


@pytest.mark.parametrize("gamma", [0.5, 1.0])
def test_tips_that_lag_behind_a_fast_load_turn_in_time(gamma):
    """By more than the tolerance later than tips at rest."""
    scene = turning_scene(bending=0.15)
    ts, z, mode = sampled(scene, 0.1, gamma, gap=GAP)
    args = {"eps": 0.1, "gamma": gamma, "scene": scene}
    found = certified("", ts, z, mode, **args)
    assert found.ok, found


@both
def test_noise_of_a_hundredth_is_accepted(name):
    ts, z, mode = by_library(name)
    noise = np.random.default_rng(0).uniform(-0.01, 0.01, z.size)
    found = certified(name, ts, z + EPS * noise, mode)
    assert found.ok, found
    assert 0.008 < found.distance < 0.012


@both
def test_the_balance_of_energies_closes_with_what_jumps_lose(name):
    """What is left is small beside what is lost, in jumps as much as the limit says."""
    ts, z, mode = by_library(name)
    lost = np.asarray(fx.solve_limit(SCENES[name]).dissipation)[-1]
    found = accepted(name)
    assert found.residual < 1e-3 * lost
    assert found.residual <= 4 * found.residual_error + 1e-4 * lost
    # Without the viscosity of jumps the same curve leaves what they lose.
    before, after = first_turn(mode)
    late = ts.copy()
    late[before + 1 :] += 0.5 * (ts[after] - ts[before])  # it takes half as long again
    late[before + 1 : after + 1] = np.interp(
        ts[before + 1 : after + 1], ts[[before, after]], late[[before, after]]
    )
    inside = late <= 4.0
    slower = certified(name, late[inside], z[inside], mode[inside])
    assert not slower.ok
    assert slower.distance > 0.3
    assert slower.residual > 100 * found.residual


@pytest.mark.slow  # a program of its own
def test_curves_by_scipy_are_accepted():
    found = by_scipy_certified()
    assert found.ok, found
    assert set(by_scipy()[2].tolist()) == {1, 0, -1}
    assert found.distance < 2e-3


@pytest.mark.parametrize(("name", "shift"), [*SHIFTS, *SLOW_SHIFTS])
def test_shifted_curves_are_rejected(name, shift):
    ts, z, mode = turned_once(name)
    assert not certified(name, ts, z + shift * EPS, mode).ok
    for one in (1, 0, -1):
        found = certified(name, ts, z + shift * EPS * (mode == one), mode)
        assert not found.ok
        assert found.distance > 0.05


@both
@pytest.mark.parametrize("other", [0.1, -0.1])
def test_another_gamma_is_rejected(name, other):
    found = certified(name, *turned_once(name), gamma=GAMMA + other)
    assert found.status.name == "VISCOSITY"
    assert found.viscosity == pytest.approx(EPS**-other, rel=0.02)


@both
@pytest.mark.parametrize("factor", [0.9, 0.99, 1.01, 1.05])
def test_another_bending_stiffness_is_rejected(name, factor):
    stiffness = factor * SCENES[name].effects[0].bending_stiffness
    scene = SCENES[name].replace(effects=(fx.effects.NapFlip(stiffness),))
    found = certified(name, *turned_once(name), scene=scene)
    assert found.status.name == "TURN"
    assert found.skipped > 0


@both
def test_a_turn_later_by_a_hundredth_of_the_load_is_rejected(name, monkeypatch):
    late = turned_at(1.01, monkeypatch, SCENES[name])
    assert certified(name, *late).status.name == "TURN"


@pytest.mark.slow  # the same program
def test_a_turn_later_by_a_hundredth_is_rejected_of_scipy_too():
    assert by_scipy_certified(1.01).status.name == "TURN"


@both
def test_a_turn_earlier_by_a_hundredth_of_the_load_is_rejected(name):
    ts, z, mode = turned_once(name)
    last, _ = first_turn(mode)
    loads = np.asarray(part_at(SCENES[name].load, ts))[: last + 1]
    early = mode.copy()
    soon = loads < loads[last] + 0.01 * float(standing_rod(SCENES[name]).places.share[0])
    early[np.flatnonzero(soon & (ts[: last + 1] > 1.0))] = 0
    assert np.sum(early != mode) > 1
    assert certified(name, ts, z, early).status.name == "TURN"


@both
def test_a_turn_that_is_missing_is_rejected(name, monkeypatch):
    against = turned_at(2.5, monkeypatch, SCENES[name])
    assert set(against[2].tolist()) == {1}
    assert certified(name, *against).status.name == "TURN"


@pytest.mark.parametrize("beyond", [-0.01, 0.01])
def test_a_load_that_turns_back_just_past_it_turns_the_rod(beyond, monkeypatch):
    """By 1% of the critical load past what turns it over, or before that."""
    scene = turning_scene(amplitude=0.1, duration=3.4)
    rod, there = standing_rod(scene), np.array([3.0])
    ts, z, _ = turned_at(1.2, monkeypatch, scene)
    near = rod.beside(np.interp(there, ts, z))
    (least,) = rod.overloads(EPS**GAMMA, near, there)
    amplitude = 0.1 + (beyond - least) * float(rod.places.share[0])
    scene = turning_scene(amplitude=amplitude, duration=3.4)
    ts, z, mode = turned_at(1.2, monkeypatch, scene)
    assert set(mode.tolist()) == {1}
    found = certified("led", ts, z, mode, scene=scene)
    assert found.status.name == ("TURN" if beyond > 0 else "OK")
    away = np.abs(ts - 3.0) > 0.05
    unseen = certified("led", ts[away], z[away], mode[away], scene=scene)
    assert unseen.status.name == ("UNRESOLVED" if beyond > 0 else "OK")


@both
def test_modes_that_are_not_its_own_are_rejected(name):
    ts, z, mode = turned_once(name)
    assert not certified(name, ts, z, -mode).ok
    once = np.where(mode == 0, 1, mode)
    found = certified(name, ts, z, once)
    assert not found.ok
    assert found.distance == np.inf
    _, last = first_turn(mode)
    for rows, value in ((slice(last - 10, last + 1), -1), (slice(last + 1, last + 20), 0)):
        other = mode.copy()
        other[rows] = value
        assert not certified(name, ts, z, other).ok


def test_the_root_is_where_the_state_is():
    ts, z, mode = turned_once("led")
    root = z + REACH
    root[100] += 0.1 * EPS
    found = certified("led", ts, z, mode, root=root)
    assert found.status.name == "OFF"
    assert found.distance == pytest.approx(0.1)


def test_curves_that_cannot_be_judged_are_not_accepted():
    ts, z, mode = turned_once("led")
    coarse = certified("led", ts[::8], z[::8], mode[::8])
    assert coarse.status.name == "UNRESOLVED"
    last, _ = first_turn(mode)
    far = np.abs(ts - ts[last]) > 5e-3
    assert certified("led", ts[far], z[far], mode[far]).status.name == "UNRESOLVED"
    root = z + REACH
    root[3] = np.nan
    assert certified("led", ts, z, mode, root=root).status.name == "NOT_FINITE"


@pytest.mark.parametrize(
    ("name", "given", "needs"),
    [
        ("root", None, "u in m of the shape"),
        ("root", [1.0], "u in m of the shape"),
        ("mode", None, "1, -1 and 0 of the shape"),
        ("mode", [1, 1], "1, -1 and 0 of the shape"),
        ("mode", [1, 2, 1], "1, -1 and 0 of the shape"),
        ("mode", [1, 0.5, 1], "1, -1 and 0 of the shape"),
        ("mode", [0, 0, 1], r"1 or -1: where the tip"),
    ],
)
def test_it_needs_root_and_mode(name, given, needs):
    z = np.zeros(3)
    good = {"root": z + REACH, "mode": [1, 1, 1]}
    with pytest.raises(ValueError, match=rf"(?s)^{name}.* = .*needs {needs}"):
        fx.certify(SCENES["led"], EPS, GAMMA, [0.0, 0.1, 0.2], z, **(good | {name: given}))


@pytest.mark.parametrize("name", ["root", "mode"])
def test_no_other_scene_has_them(name):
    plain, z = SCENES["led"].replace(effects=()), np.zeros(3)
    with pytest.raises(ValueError, match=rf"(?s)^{name} = .*needs None, or a scene with"):
        fx.certify(plain, EPS, GAMMA, [0.0, 0.1, 0.2], z, **{name: np.ones(3)})


@pytest.mark.slow
@pytest.mark.parametrize("gamma", [0.5, 0.75, 1.0, 2.0])
@pytest.mark.parametrize("eps", [1e-2, 1e-3])
@both
def test_small_eps_and_other_gammas(name, eps, gamma):
    ts, z, mode = sampled(SCENES[name], eps, gamma)
    args = {"eps": eps, "gamma": gamma}
    found = certified(name, ts, z, mode, **args)
    assert found.ok, found
    assert found.distance < 5e-3
    assert not certified(name, ts, z + 0.1 * eps, mode, **args).ok
    assert not certified(name, ts, z, mode, eps=eps, gamma=gamma + 0.1).ok
