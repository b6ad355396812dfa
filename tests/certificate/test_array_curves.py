"""Every bristle of an array is certified, each by its own row."""

from functools import cache

import numpy as np
import pytest

import frictionjax as fx

OFFSETS = 0.0, 0.3, -2.71
EPS, GAMMA = 0.1, 1.0
TS = np.linspace(0.0, 3.0, 4001)


def array_of(*offsets) -> fx.Scene:
    return fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        3.0,
        effects=(fx.effects.CompliantArray(np.array(offsets)),),
    )


def bristle(offset):
    solved = fx.solve(array_of(offset), EPS, GAMMA, TS, accuracy=1e-6, dissipation=False)
    return np.asarray(solved.z)


@cache
def rows():
    return np.stack([bristle(offset) for offset in OFFSETS])


def certified(z, gamma=GAMMA, scene=None):
    return fx.certify(scene or array_of(*OFFSETS), EPS, gamma, TS, z)


def test_rows_of_all_bristles_are_accepted():
    found = certified(rows())
    assert found.ok, found
    assert found.distance < 1e-3
    noise = np.random.default_rng(0).uniform(-1, 1, rows().shape)
    noisy = certified(rows() + 0.01 * EPS * noise)
    assert noisy.ok
    assert noisy.distance <= 0.012


def test_sums_are_of_all_bristles_and_the_rest_of_the_worst():
    alone = [
        certified(row[None], scene=array_of(offset))
        for offset, row in zip(OFFSETS, rows(), strict=True)
    ]
    found = certified(rows())
    assert found.slips == sum(one.slips for one in alone) > 30
    assert found.residual == pytest.approx(sum(one.residual for one in alone))
    assert found.residual_error == pytest.approx(sum(o.residual_error for o in alone))
    assert found.scale == alone[1].scale
    assert found.distance == max(one.distance for one in alone)
    assert found.missing_force == max(one.missing_force for one in alone)
    assert found.viscosity in {one.viscosity for one in alone}
    assert all(abs(one.viscosity - 1) <= abs(found.viscosity - 1) for one in alone)


@pytest.mark.parametrize("which", range(3))
def test_one_bristle_that_is_wrong_is_enough(which):
    z = rows().copy()
    z[which] += 0.1 * EPS
    found = certified(z)
    assert not found.ok
    assert 0.05 <= found.distance <= 0.1001
    z[which] = rows()[which] + EPS * (TS > 0.6)
    assert not certified(z).ok
    z[which, 7] = np.nan
    assert certified(z).status.name == "NOT_FINITE"


def test_rows_belong_to_their_bristles():
    assert not certified(rows()[[1, 0, 2]]).ok
    assert certified(rows(), gamma=1.1).status.name == "VISCOSITY"


def test_the_mean_of_bristles_is_not_taken_for_one():
    with pytest.raises(ValueError, match=r"(?s)^z = .*\(3, 4001\), a row a bristle"):
        certified(np.mean(rows(), axis=0))
