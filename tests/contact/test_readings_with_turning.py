"""Mechanics of a rod that turns over: straight either way, and bent over its tip."""

import numpy as np
import pytest
import xarray as xr
from rods_that_turn import REACH, jumping_scene, turning_scene
from scipy.optimize import brentq

import frictionjax as fx
from frictionjax.limit import LimitSolution

EPS = 0.02


def around(*times):
    """Fine times with two for each of these and each turn of the load, before and after."""
    kinks = np.array([1.0, 3.0, *times])
    beside = [kinks - 1e-9, kinks + 1e-9]
    return np.unique(np.concatenate([np.linspace(0, 4, 2001), *beside]))


@pytest.fixture(scope="module")
def limit():
    one = turning_scene()
    return fx.mechanics(one, fx.solve_limit(one, around()))


@pytest.fixture(scope="module")
def jumping():
    one = jumping_scene()
    rough = fx.mechanics(one, fx.solve_limit(one, [0.0, 4.0]))
    ts = around(*rough.jump_time.values)
    return fx.mechanics(one, fx.solve_limit(one, ts))


@pytest.fixture(scope="module")
def wiggly():
    one = turning_scene()
    found = fx.solve(one, EPS, 1.0, around(), accuracy=1e-4)
    return fx.mechanics(one, found, EPS)


def gained(data):
    """Energies less the work put in, and with what is lost: what balances."""
    power, time = data.power.values, data.time.values
    work = np.cumsum(np.diff(time) * 0.5 * (power[1:] + power[:-1]))
    energy = (data.energy_support + data.energy_bristle).values
    return energy[1:] - energy[0] - work + data.dissipation.values[1:]


def test_energies_of_the_limit_are_balanced_across_its_jumps(jumping, limit):
    assert jumping.sizes["jump"] >= 2
    assert np.all(jumping.jump_loss > 0.01)
    assert np.max(np.abs(gained(jumping))) < 5e-5
    assert np.max(np.abs(gained(limit))) < 2e-5
    assert limit.sizes["jump"] == 0


def test_what_jumps_lose_is_lost_when_they_say(jumping):
    times, spent = jumping.time.values, jumping.dissipation.values
    z = jumping.z.values
    rows = zip(
        *(jumping[n].values for n in ("jump_time", "jump_from", "jump_to", "jump_loss")),
        strict=True,
    )
    for time, start, end, lost in rows:
        before, after = np.searchsorted(times, time) - 1, np.searchsorted(times, time) + 1
        assert spent[after] - spent[before] == pytest.approx(lost, abs=1e-3)
        assert z[before] == pytest.approx(start, abs=5e-3)
        assert z[after] == pytest.approx(end, abs=5e-3)


def test_energies_at_finite_eps_are_balanced():
    """With slips slow enough for the trapezoid rule."""
    one = turning_scene()
    found = fx.solve(one, 0.1, 0.6, around(), accuracy=1e-4)
    readings = fx.mechanics(one, found, 0.1)
    assert set(readings["mode"].values) == {1, 0, -1}
    off = np.max(np.abs(gained(readings))) / float(readings.dissipation[-1])
    assert off < 1e-5


@pytest.mark.parametrize("which", ["limit", "jumping", "wiggly"])
def test_rods_are_as_long_as_they_are(which, request):
    data = request.getfixturevalue(which)
    np.testing.assert_allclose(data.u, data.z + REACH, atol=1e-12)
    ahead = data.length * np.sin(data.theta)
    np.testing.assert_allclose(ahead, data.u - data.p, atol=1e-9)
    low = 0.5 * EPS / (2 * np.pi) * np.sin(2 * np.pi * data.p / EPS)
    height = 1.0 - (low if which == "wiggly" else 0.0)
    np.testing.assert_allclose(data.length * np.cos(data.theta), height, atol=1e-9)
    straight = data["mode"] != 0
    np.testing.assert_allclose(data.length[straight], 2**0.5, rtol=1e-12)
    assert np.all(data.length[~straight] < 2**0.5 + 1e-12)
    assert np.all(np.sign(data.theta[straight]) == data["mode"][straight])


@pytest.mark.parametrize("which", ["limit", "wiggly"])
@pytest.mark.parametrize("mode", [1, 0, -1])
def test_forces_are_derivatives_of_energies(which, mode, request):
    """Along the solution: -dE/dz, by differences, of the bristle and of its support."""
    data = request.getfixturevalue(which)
    z, own = data.z.values, data["mode"].values
    near = (own[1:] == mode) & (own[:-1] == mode)
    # At finite eps a step of 1% of a period bends the force of a well.
    longest = 2e-4 if which == "wiggly" and mode else 1e-2
    near &= (np.abs(np.diff(z)) > 1e-6) & (np.abs(np.diff(z)) < longest)
    assert near.sum() > 20
    energy, force = data.energy_bristle.values, data.tangential_force.values
    change = np.diff(energy)[near] / np.diff(z)[near]
    middle = 0.5 * (force[1:] + force[:-1])[near]
    if which == "limit" and mode:  # its tips slide: energy stays, and friction does work
        np.testing.assert_allclose(change, 0, atol=1e-9)
        return
    atol = 1e-4 if mode == 0 else 5e-3
    np.testing.assert_allclose(-change, middle, atol=atol)


def test_roots_are_in_balance(limit, wiggly):
    np.testing.assert_allclose(limit.tangential_force, -limit.support_force, atol=1e-9)
    rests = np.abs(np.gradient(wiggly.z, wiggly.time)) < 2
    force = (wiggly.support_force + wiggly.tangential_force)[rests]
    speed = np.gradient(wiggly.z, wiggly.time)[rests]
    np.testing.assert_allclose(np.median(np.abs(force - EPS * speed)), 0, atol=1e-3)


def test_it_turns_where_its_share_is_one(limit):
    mode = limit["mode"].values
    share = limit.buckling_share.values
    begins = np.flatnonzero((mode[1:] == 0) & (mode[:-1] != 0))
    assert begins.size >= 1
    np.testing.assert_allclose(share[begins], 1, atol=1.2e-2)
    np.testing.assert_allclose(share[begins + 1], 1, atol=2e-2)
    assert np.all(share[mode != 0] <= 1 + 1e-9)
    assert np.all(share[mode == 0] >= 1 - 1e-9)
    assert limit.attrs["critical_load"] == pytest.approx(np.pi**2 * 0.1 / 2)


def test_friction_of_a_limit_is_what_its_rod_withstands(limit):
    low, high = limit.tangential_low, limit.tangential_high
    force, mode = limit.tangential_force, limit["mode"]
    assert np.all((low - 1e-9 <= force) & (force <= high + 1e-9))
    law = fx.nap(turning_scene().profile, turning_scene().bristle)
    slides = (low == high) & (mode == 1)
    np.testing.assert_allclose(force[slides], -law.rho_with, rtol=1e-9)
    slides = (low == high) & (mode == -1)
    np.testing.assert_allclose(force[slides], law.rho_flipped, rtol=1e-9)
    rests = low < high
    assert {1, -1} <= set(mode.values[rests])
    assert not np.any(rests & (mode == 0))


def test_at_small_eps_it_is_the_limits(limit, wiggly):
    same = limit["mode"].values == wiggly["mode"].values
    assert np.mean(same) > 0.97
    between = same & (limit["mode"].values == 0)
    for name, off in (("theta", 0.15), ("length", 0.1), ("energy_bristle", 0.05)):
        apart = np.abs(limit[name] - wiggly[name]).values
        assert np.max(apart[between]) < off, name
    assert np.max(np.abs(limit.p - wiggly.p).values[same]) < 5 * EPS


@pytest.fixture(scope="module")
def held():
    """The limit's scene, asked for its axial load too, and the load of Timoshenko."""
    one = turning_scene()
    one = one.replace(effects=(*one.effects, fx.effects.AxialLoad(0.1)))
    clamping = 2**0.5 / 0.1
    u = brentq(lambda u: np.tan(u) - u / (1 + u**2 / clamping), np.pi + 1e-9, 4.6)
    return one, u**2 * 0.1 / 2


def test_straight_modes_are_held_against_the_rod_on_its_spring(held, limit):
    one, load = held
    data = fx.mechanics(one, fx.solve_limit(one, around()))
    assert data.attrs["sprung_load"] == pytest.approx(load, rel=1e-9)
    bent = data["mode"].values == 0
    assert set(data["mode"].values) == {1, 0, -1}
    assert np.all(np.isnan(data.sprung_share[bent]))
    straight = data.compression[~bent] / load
    np.testing.assert_allclose(data.sprung_share[~bent], straight, rtol=1e-9)
    # It turns where it comes to the smaller load, so that this is all it comes to.
    most = np.pi**2 * 0.1 / 2 / load
    assert float(data.sprung_share.max()) == pytest.approx(most, rel=1e-2)
    assert float(data.sprung_share.max()) < most + 1e-9
    assert "not shown to buckle" in data.sprung_buckling
    xr.testing.assert_identical(
        data.drop_vars("sprung_share").drop_attrs(), limit.drop_attrs()
    )
    assert data.attrs.items() > limit.attrs.items()


def test_slips_pass_the_load_of_the_rod_on_its_spring(held, wiggly):
    one, load = held
    data = fx.mechanics(one, fx.solve(one, EPS, 1.0, around(), accuracy=1e-4), EPS)
    np.testing.assert_array_equal(data.compression, wiggly.compression)
    straight = data.compression[data["mode"] != 0]
    assert float(straight.max()) > 2 * load
    assert data.sprung_buckling == "beyond the critical load somewhere: buckles"


def test_where_it_is_bent_all_the_time_nothing_is_said(held):
    one, _ = held
    known = fx.solve_limit(one, around())
    bent = np.asarray(known.mode) == 0
    kept = {
        name: np.asarray(getattr(known, name))[bent]
        for name in ("ts", "z", "dissipation", "root", "mode", "tip")
    }
    data = fx.mechanics(one, LimitSolution(**kept))
    assert data.sprung_buckling == "nothing straight to be told of at these times"


def test_a_solution_of_another_scene_is_refused():
    one = turning_scene()
    plain = fx.solve_limit(one.replace(effects=()), [0.0, 1.0])
    with pytest.raises(ValueError, match="one without root, tip and mode"):
        fx.mechanics(one, plain)
