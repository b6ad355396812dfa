import numpy as np
import pytest
from noisy_wells import SLANTED
from scipy import stats

import frictionjax as fx
from frictionjax.effects import Noise
from frictionjax.stochastic import (
    PathStatus,
    key_words,
    mean_interval,
    noisy_paths,
    path_keys,
)

SCENE = fx.Scene(
    SLANTED.profile,
    SLANTED.bristle,
    fx.supports.Spring(1.0),
    fx.loads.Triangle(1.5, 4.0),
    4.0,
)
NOISE = Noise(0.02)
CELL = {"eps": 0.05, "gamma": 1.0}


def test_a_path_has_the_same_bits_alone_in_company_and_at_other_times():
    keys = path_keys(3, 40)
    ts = np.linspace(0.0, 4.0, 9)
    together = noisy_paths(SCENE, NOISE, keys=keys, ts=ts, **CELL)
    for one in (0, 17, 39):
        alone = noisy_paths(SCENE, NOISE, keys=keys[one : one + 1], ts=ts, **CELL)
        assert np.array_equal(alone.z[0], together.z[one])
        assert np.array_equal(alone.work[0], together.work[one])
    denser = noisy_paths(SCENE, NOISE, keys=keys[:2], ts=np.linspace(0, 4, 801), **CELL)
    assert np.array_equal(denser.z[:, ::100], together.z[:2])
    assert np.unique(together.z[:, -1]).size == 40


def test_values_at_the_start_and_where_times_repeat():
    found = noisy_paths(
        SCENE, NOISE, keys=path_keys(3, 2), ts=[0.0, 0.0, 1.0, 1.0, 4.0], z0=0.3, **CELL
    )
    assert np.all(found.z[:, :2] == 0.3)
    assert np.all(found.work[:, :2] == 0)
    assert np.array_equal(found.z[:, 2], found.z[:, 3])
    assert found.ok.all()
    assert found.step * found.steps == pytest.approx(4.0)
    assert "2 of 2 OK: 2 paths, 5 times" in repr(found)


def test_energy_that_paths_lose_is_about_what_the_limit_dissipates():
    found = noisy_paths(SCENE, Noise(1e-4), keys=path_keys(4, 32), ts=[0.0, 4.0], **CELL)
    limit = fx.solve_limit(SCENE)
    # The load is 0 at both ends: what is left is the energy of the spring.
    stored = 0.5 * (found.z[:, -1] ** 2 - found.z[:, 0] ** 2)
    lost = np.mean(found.work[:, -1] - stored)
    assert lost == pytest.approx(float(limit.dissipation[-1]), rel=0.1)


def test_noise_of_another_temperature_is_another_path():
    key = key_words(0)[None]
    cold, warm = (
        noisy_paths(SCENE, noise, keys=key, **CELL).z
        for noise in (Noise(0.02), Noise(0.02, exponent=0.5))
    )
    assert cold.shape == (1, 201)
    assert np.std(np.diff(warm)) > 1.5 * np.std(np.diff(cold))


def test_the_interval_is_students_and_holds_the_mean():
    values = np.random.default_rng(0).normal(2.0, 1.0, (12, 500))
    found = mean_interval(values)
    low, high = stats.t.interval(0.95, 11, values.mean(axis=0), stats.sem(values, axis=0))
    assert found.low == pytest.approx(low)
    assert found.high == pytest.approx(high)
    held = np.mean((found.low < 2.0) & (found.high > 2.0))
    assert 0.92 < held < 0.98
    alone = mean_interval(values[:1])
    assert np.all(np.isinf(alone.low))
    assert np.array_equal(alone.mean, values[0])


def test_a_support_that_hardens_beyond_what_was_seen_has_a_status():
    wall = fx.supports.Convex(lambda z: 0.5 * z**2 + 1e3 * z**12)
    scene = SCENE.replace(support=wall)
    found = noisy_paths(scene, NOISE, keys=path_keys(0, 2), z0=[0.0, 30.0], **CELL)
    assert list(found.status) == [PathStatus.OK, PathStatus.NOT_FINITE]
    assert list(found.ok) == [True, False]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"eps": -1.0}, "eps = -1: needs eps > 0"),
        ({"eps": 1e-14}, "eps = 1e-14: needs eps >= "),
        ({"gamma": 0.0}, "gamma = 0: needs"),
        ({"ts": [5.0]}, "ts = .*duration"),
        ({"z0": [0.0, 1.0, 2.0]}, r"z0 = 'shape \(3,\)': needs one number"),
        ({"z0": np.nan}, "z0 = nan: needs finite"),
    ],
)
def test_numbers_out_of_range_are_named(change, message):
    given = CELL | {"keys": path_keys(0, 2)} | change
    with pytest.raises(ValueError, match=message):
        noisy_paths(SCENE, NOISE, **given)
