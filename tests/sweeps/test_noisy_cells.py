"""Sweeps of scenes with thermal noise."""

import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.stochastic import cell_keys, key_words, path_steps
from frictionjax.wiggly import OURS, Status
from frictionjax.wiggly.equation.status import FailedCells

TS = np.array([0.0, 0.5, 0.5, 1.3, 2.0])
EPS, GAMMA = [0.1, 0.05], [0.75, 1.0]


def scene_with(*effects, load=None):
    profile = fx.profiles.Sine(0.4)
    bristle = fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.9)
    load = load or fx.loads.Triangle(1.5, 2.0)
    parts = profile, bristle, fx.supports.Spring(1.0), load, 2.0
    return fx.Scene(*parts, effects=effects)


NOISY = scene_with(fx.effects.Noise(0.02))


def path_of(data, gamma, eps):
    return jnp.asarray(data.path_key.sel(gamma=gamma, eps=eps).values)


def test_a_cell_has_the_same_bits_alone_in_any_grid_and_in_solve():
    data = fx.sweep(NOISY, EPS, GAMMA, TS, key=3)
    assert np.all(data.status == 0)
    alone = fx.sweep(NOISY, 0.05, 0.75, TS, key=3)
    for name in ("z", "sup_error", "strip_excess", "steps", "path_key"):
        one = data[name].sel(gamma=0.75, eps=0.05)
        assert np.array_equal(one, alone[name].squeeze())
    path = fx.solve(NOISY, 0.05, 0.75, TS, key=path_of(data, 0.75, 0.05))
    assert np.array_equal(path.z, data.z.sel(gamma=0.75, eps=0.05))
    other = fx.sweep(NOISY, 0.05, 0.75, TS, key=4)
    assert not np.any(other.z[..., 1:] == alone.z[..., 1:])
    several = fx.sweep({"a": NOISY, "b": NOISY}, 0.05, 0.75, TS, key=3)
    assert np.array_equal(several.z[1], alone.z)


def test_a_cell_that_fails_has_its_status_and_the_others_what_they_have_alone():
    """Into a wall steeper than its steps know goes the hot one, not the cold one."""
    wall = fx.supports.Convex(lambda z: 0.5 * z**2 + jnp.exp(200 * (z**2 - 9)))
    hot = scene_with(fx.effects.Noise(3e8, 8.0)).replace(support=wall)
    with pytest.warns(FailedCells, match=r"eps = 0\.1") as told:
        data = fx.sweep(hot, [0.1, 0.05], [0.75], TS, key=3)
    assert len(told) == 1
    assert data.status.values.tolist() == [[Status.NOT_FINITE, Status.OK]]
    failed, good = data.isel(gamma=0, eps=0), data.isel(gamma=0, eps=1)
    assert failed.z.shape == TS.shape
    assert np.isnan(failed.z[-1])
    assert np.isnan(failed.sup_error)
    assert np.isnan(failed.strip_excess)
    alone = fx.sweep(hot, [0.05], [0.75], TS, key=3).squeeze()
    for name in ("z", "sup_error", "strip_excess", "steps", "status"):
        assert np.array_equal(good[name], alone[name]), name
    assert np.all(np.isfinite(good.z))


def test_a_cell_of_too_many_steps_has_its_status_too(monkeypatch):
    """Alone such a path is refused by its eps."""
    most = fx.solve(NOISY, 0.1, 1.0, TS, key=3).stats["steps"]
    few = path_steps.SETTINGS._replace(most_steps=most)
    monkeypatch.setattr(path_steps, "SETTINGS", few)
    with pytest.warns(FailedCells, match=r"eps = 0\.05"):
        data = fx.sweep(NOISY, EPS, [1.0], TS, key=3)
    assert data.status.values.tolist() == [[Status.OK, Status.MAX_STEPS]]
    assert np.all(np.isnan(data.z[0, 1]))
    assert np.all(np.isfinite(data.z[0, 0]))
    assert data.steps[0, 1] == 0
    with pytest.raises(ValueError, match=rf"eps = 0\.05: needs at most {most} steps"):
        fx.solve(NOISY, 0.05, 1.0, TS, key=3)


@pytest.mark.parametrize(
    "other",
    [
        scene_with(),
        pytest.param(scene_with(fx.effects.Inertia(1e-4)), marks=pytest.mark.slow),
        pytest.param(
            scene_with(fx.effects.CompliantArray([0.0, 0.3])), marks=pytest.mark.slow
        ),
    ],
)
def test_scenes_of_other_effects_are_beside_it_as_alone(other):
    """What one of them does not have is NaN."""
    both = fx.sweep({"noisy": NOISY, "other": other}, [0.1], [1.0], TS, key=3)
    for label, scene, key in (("noisy", NOISY, 3), ("other", other, None)):
        one, alone = both.sel(scene=label), fx.sweep(scene, [0.1], [1.0], TS, key=key)
        for name in alone.data_vars:
            known = alone[name].broadcast_like(one[name]).transpose(*one[name].dims)
            assert np.array_equal(one[name], known, equal_nan=True), name
    assert np.all(np.isnan(both.dissipation.sel(scene="noisy")))
    assert np.all(both.how.sel(scene="noisy") == 0)


def test_keys_of_cells_are_all_different():
    eps, gamma = np.array([0.1, 0.1, 0.05, 0.05]), np.array([1.0, 0.5, 1.0, 0.5])
    keys = cell_keys(key_words(0), eps, gamma)
    assert np.unique(keys, axis=0).shape == (4, 2)
    assert np.array_equal(cell_keys(key_words(0), eps[2:3], gamma[2:3]), keys[2:3])


def test_suprema_are_those_of_the_path():
    data = fx.sweep(NOISY, [0.05], [1.0], TS, key=3).squeeze()
    ts = np.linspace(0.0, 2.0, 100_001)
    path = fx.solve(NOISY, 0.05, 1.0, ts, key=jnp.asarray(data.path_key.values))
    limit = fx.solve_limit(scene_with(), ts)
    sup = float(np.max(np.abs(path.z - limit.z)))
    assert sup * 0.97 <= float(data.sup_error) <= sup
    assert float(data.sup_error) >= float(np.max(np.abs(data.z - data.z_limit)))
    assert 0 < float(data.strip_excess) < float(data.sup_error)
    law = fx.friction(NOISY)
    share = 0.02 / float(law.rho_plus - law.rho_minus)
    assert float(data.thermal_share) == pytest.approx(share, rel=1e-9)


def test_what_a_path_does_not_have_is_absent_and_the_rest_is_described():
    data = fx.sweep(NOISY, [0.1], [1.0], TS, key=0)
    absent = {"dissipation", "residual", "bracket", "survey_error", "dissipation_gap"}
    assert not absent & set(data.variables)
    assert all(data[name].attrs["long_name"] for name in data.variables)
    bare = fx.sweep(NOISY, [0.1], [1.0], TS, key=0, suprema=False)
    assert "sup_error" not in bare
    assert np.array_equal(bare.z, data.z)


@pytest.mark.parametrize(("exponent", "falls"), [(2.0, True), (1.0, False)])
def test_a_study_says_whether_noise_vanishes(exponent, falls):
    noise = fx.effects.Noise(0.02 * 0.1 ** (1 - exponent), exponent)
    data = fx.sweep(scene_with(noise), np.geomspace(0.1, 0.02, 6), [1.0], TS, key=0)
    orders = fx.study(data).orders
    assert float(orders.noise_order[0]) == pytest.approx(exponent - 1)
    assert ("dry friction for eps -> 0" in orders.attrs["noise"]) == falls
    assert orders.law.values[0] == "free"
    assert np.isfinite(float(orders.order_seen[0]))
    assert orders.noise_order.attrs["long_name"]


@pytest.mark.parametrize(
    ("scene", "change", "message"),
    [
        (NOISY, {"key": None}, "key = None: needs a seed"),
        (scene_with(), {"key": 0}, r"key = 0: needs None, or a scene with effects\.Noise"),
        (NOISY, {"accuracy": 1e-4}, "accuracy = 0.0001: needs its default: steps of"),
        (NOISY, {"method": "Kvaerno5"}, "solver of diffrax.* does not do Noise: needs"),
    ],
)
def test_what_cannot_be_done_is_refused_by_name(scene, change, message):
    given = {"eps": [0.1], "gamma": [1.0], "ts": TS, "key": 0} | change
    with pytest.raises(ValueError, match=message):
        fx.sweep(scene, **given)


@pytest.mark.parametrize("method", OURS[1:])
def test_each_method_of_ours_takes_the_same_path(method):
    given = {"eps": [0.1], "gamma": [1.0], "ts": TS, "key": 0}
    assert np.array_equal(
        fx.sweep(NOISY, **given, method=method).z, fx.sweep(NOISY, **given).z
    )
