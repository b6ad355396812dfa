"""Curves with mass: accepted where a solution stays close to them, and only there."""

from functools import cache

import numpy as np
import pytest
from tips_with_mass import by_scipy, mass_for, massive_scene

import frictionjax as fx
from frictionjax.certificate import massive_curve

EPS, GAMMA = 0.05, 1.0
TS = np.linspace(0.0, 1.5, 2501)
BETAS = {"overdamped": 0.02, "between": 1.0, "several wells a slip": 50.0}
# What is rejected is so at one beta in every run, at the others in the slow one.
FEW_BETAS = [
    pytest.param(beta, id=name, marks=[pytest.mark.slow] if beta < 50 else [])
    for name, beta in BETAS.items()
]


def scene_of(beta) -> fx.Scene:
    return massive_scene(mass_for(beta, EPS, GAMMA))


@cache
def by_library(beta):
    found = fx.solve(scene_of(beta), EPS, GAMMA, TS)
    assert found.ok
    return np.asarray(found.z), np.asarray(found.velocity)


def certified(beta, z, velocity, gamma=GAMMA, ts=TS):
    return fx.certify(scene_of(beta), EPS, gamma, ts, z, velocity=velocity)


@pytest.mark.parametrize("beta", BETAS.values(), ids=BETAS)
def test_solutions_of_the_library_are_accepted(beta):
    z, velocity = by_library(beta)
    found = certified(beta, z, velocity)
    assert found.ok, found
    assert found.distance < 2e-3
    assert found.slips > 10
    assert abs(found.viscosity - 1) < 0.01
    noise = np.random.default_rng(0).uniform(-1, 1, TS.size)
    noisy = certified(beta, z + 0.01 * EPS * noise, velocity)
    assert noisy.ok
    assert 0.008 < noisy.distance <= 0.012


def test_tables_tell_what_the_parts_tell(monkeypatch):
    z, velocity = by_library(1.0)
    curve = z + 0.003 * EPS, velocity
    by_tables = certified(1.0, *curve)
    used = []
    exact = massive_curve.force_in_tables

    def by_parts(force, ts):
        used.append(exact(force, ts) is not force)
        return force

    monkeypatch.setattr(massive_curve, "force_in_tables", by_parts)
    found = certified(1.0, *curve)
    assert used == [True]
    assert found.status == by_tables.status
    for name in ("distance", "viscosity", "residual"):
        known = getattr(by_tables, name)
        assert getattr(found, name) == pytest.approx(known, rel=1e-5, abs=1e-11), name


@pytest.mark.parametrize("beta", [1.0, 50.0])
def test_solutions_by_scipy_are_accepted(beta):
    z, velocity, lost = by_scipy(mass_for(beta, EPS, GAMMA), EPS, GAMMA, TS)
    found = certified(beta, z, velocity)
    assert found.ok, found
    assert found.distance < 1e-4
    assert found.residual < 1e-3 * lost[-1]
    assert found.residual <= 4 * found.residual_error + 1e-6 * lost[-1]


@pytest.mark.parametrize("beta", FEW_BETAS)
@pytest.mark.parametrize("shift", [0.1, -0.1])
def test_shifted_curves_are_rejected(beta, shift):
    z, velocity = by_library(beta)
    found = certified(beta, z + shift * EPS, velocity)
    assert not found.ok
    assert found.distance > 0.05


@pytest.mark.parametrize("beta", FEW_BETAS)
@pytest.mark.parametrize("other", [-0.1, 0.1])
def test_another_gamma_is_rejected(beta, other):
    found = certified(beta, *by_library(beta), gamma=GAMMA + other)
    assert found.status.name == "VISCOSITY"
    assert found.viscosity == pytest.approx(EPS**-other, rel=0.02)


@pytest.mark.parametrize("beta", [1.0, 50.0])
@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_another_mass_is_rejected_where_it_shows(beta, factor):
    assert not certified(factor * beta, *by_library(beta)).ok


def test_a_well_skipped_is_rejected():
    """Over a few samples, at the speed that this takes."""
    z, velocity = by_library(0.02)
    start = int(np.searchsorted(TS, 0.4))
    share = np.clip((np.arange(TS.size) - start) / 20, 0, 1)
    skipped = z + EPS * share * share * (3 - 2 * share)
    found = certified(0.02, skipped, velocity + np.gradient(skipped - z, TS))
    assert found.spacing < 0.25
    assert not found.ok


@pytest.mark.parametrize("beta", [pytest.param(1.0, marks=pytest.mark.slow), 50.0])
def test_an_overdamped_solution_is_rejected_where_mass_matters(beta):
    assert not certified(beta, *by_library(0.02)).ok


@pytest.mark.slow
@pytest.mark.parametrize("beta", [1.0, 50.0])
def test_a_solution_without_mass_is_rejected_where_mass_matters(beta):
    plain = scene_of(beta).replace(effects=())
    z = np.asarray(fx.solve(plain, EPS, GAMMA, TS).z)
    found = certified(beta, z, np.gradient(z, TS))
    assert found.spacing < 0.25
    assert not found.ok


@pytest.mark.parametrize("beta", FEW_BETAS)
@pytest.mark.parametrize("factor", [0.0, 0.9, 1.1])
def test_a_velocity_that_is_not_that_of_the_curve_is_rejected(beta, factor):
    z, velocity = by_library(beta)
    assert not certified(beta, z, factor * velocity).ok


def test_the_velocity_alone_is_told():
    z, velocity = by_library(1.0)
    found = certified(1.0, z, 1.1 * velocity)
    assert found.status.name == "VELOCITY"
    assert found.distance < 0.03


def test_curves_that_cannot_be_judged_are_not_accepted():
    z, velocity = by_library(1.0)
    coarse = certified(1.0, z[::32], velocity[::32], ts=TS[::32])
    assert coarse.status.name == "UNRESOLVED"
    for which in range(2):
        curve = [z.copy(), velocity.copy()]
        curve[which][5] = np.nan
        assert certified(1.0, *curve).status.name == "NOT_FINITE"


def test_steps_that_do_not_agree_leave_it_open(monkeypatch):
    from frictionjax.certificate import shadow

    z, velocity = by_library(1.0)
    thinned = z[::4], velocity[::4]
    assert certified(1.0, *thinned, ts=TS[::4]).ok
    strict = shadow.SETTINGS._replace(most=1, unsure=1e-9)  # 7e-8 is what they err by
    monkeypatch.setattr(shadow, "SETTINGS", strict)
    assert certified(1.0, *thinned, ts=TS[::4]).status.name == "UNRESOLVED"


@pytest.mark.parametrize("velocity", [None, [0.0, 1.0]])
def test_it_needs_a_velocity_of_the_shape_of_the_times(velocity):
    with pytest.raises(ValueError, match=r"^velocity = .*needs z' in m/s of the shape"):
        certified(1.0, 0 * TS, velocity)


def test_no_other_scene_has_a_velocity():
    plain = scene_of(1.0).replace(effects=())
    with pytest.raises(ValueError, match=r"(?s)^velocity = .*needs None, or a scene"):
        fx.certify(plain, EPS, GAMMA, TS, 0 * TS, velocity=0 * TS)


@pytest.mark.slow
@pytest.mark.parametrize("beta", [0.5, 20.0])
def test_a_tip_that_is_not_at_the_state(beta):
    """A rod, whose tip goes farther than its root where the surface rises."""
    mass = mass_for(beta, EPS, GAMMA)
    rod = fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2)
    scene = scene_of(1.0).replace(
        profile=fx.profiles.Sine(0.15), bristle=rod, effects=(fx.effects.Inertia(mass),)
    )
    solved = fx.solve(scene, EPS, GAMMA, TS)
    assert solved.ok
    z, velocity = np.asarray(solved.z), np.asarray(solved.velocity)
    found = fx.certify(scene, EPS, GAMMA, TS, z, velocity=velocity)
    assert found.ok, found
    assert found.distance < 2e-3
    shifted = fx.certify(scene, EPS, GAMMA, TS, z + 0.1 * EPS, velocity=velocity)
    assert not shifted.ok
    heavier = scene.replace(effects=(fx.effects.Inertia(2 * mass),))
    assert not fx.certify(heavier, EPS, GAMMA, TS, z, velocity=velocity).ok
