"""Distances of a curve, where solutions are known: a tip in wells that are hardly there."""

import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.certificate.following import FollowedCurve, distances_from_rests
from frictionjax.certificate.forces import force_in_tables, force_of

EPS = 0.1
TS = np.linspace(0.0, 2.0, 401)
SLOPE = 1e-9  # wells so shallow that z' = l - z holds
SCENE = fx.Scene(
    fx.profiles.Sine(SLOPE),
    fx.bristles.Homothetic(1.0),
    fx.supports.Spring(1.0),
    fx.loads.Ramp(1.0),
    2.0,
)
FORCE = force_in_tables(force_of(SCENE, jnp.asarray(EPS)), TS)
VISCOSITY = 0.5
STARTS = np.array([0, 120, 250])


def solution(ts, first=0.0):
    """Of `0.5 z' = t - z` from a state at 0."""
    return ts - VISCOSITY + (first + VISCOSITY) * np.exp(-ts / VISCOSITY)


def distances(z, first=STARTS):
    curve = FollowedCurve(
        ts=TS,
        z=z,
        well=np.floor(z / EPS),
        inside=z / EPS - np.floor(z / EPS),
        force=TS - z,
        stretch=np.full(TS.size, EPS),
        pace=np.ones(TS.size),
        stops=np.full(8, 2.0),  # as many as scenes have: one program
    )
    return distances_from_rests(FORCE, VISCOSITY, curve, first)


@pytest.mark.parametrize("first", [0.0, 0.3])
def test_solutions_are_near(first):
    found = distances(solution(TS, first))
    assert found.least < 1e-6
    # Two of 0.03 aside each, and what the limit makes in a moment.
    assert 0.01 < found.most < 0.06


@pytest.mark.parametrize("shift", [0.02, -0.02, 0.2, -0.2])
def test_curves_are_as_far_as_they_are(shift):
    z = solution(TS) + shift * EPS * np.minimum(1.0, TS / 0.1)
    found = distances(z)
    assert 0 <= found.least < abs(shift) + 1e-6
    if abs(shift) > 0.1:
        assert found.least > 0.2 * abs(shift)
    else:
        assert found.most > abs(shift)


def test_a_curve_that_leaves_all_solutions_has_no_bound():
    late = solution(TS) - 5 * EPS * (TS > 1.0)
    found = distances(late)
    assert found.most > 1
    assert found.least > 1


def test_one_start_is_enough():
    found = distances(solution(TS), np.array([0]))
    assert found.least < 1e-6
    assert found.most < 0.06
