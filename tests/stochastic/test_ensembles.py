import jax
import numpy as np
import pytest
from noisy_wells import SLANTED

import frictionjax as fx

NOISE = fx.effects.Noise(0.02)
LOAD = fx.loads.Triangle(1.5, 4.0)


def scene_with(*effects):
    parts = SLANTED.profile, SLANTED.bristle, fx.supports.Spring(1.0), LOAD
    return fx.Scene(*parts, 4.0, effects=effects)


SCENE = scene_with(NOISE)
TS = np.linspace(0.0, 4.0, 5)


def test_paths_are_those_of_solve_and_more_of_them_change_none():
    key = jax.random.key(3)
    found = fx.ensemble(SCENE, 0.05, 1.0, TS, 20, key)
    fewer = fx.ensemble(SCENE, 0.05, 1.0, TS, 2, 3)
    assert found.z.dims == ("path", "time")
    assert np.array_equal(found.z[:2], fewer.z)
    for path in (0, 19):
        alone = fx.solve(SCENE, 0.05, 1.0, TS, key=jax.random.fold_in(key, path))
        assert np.array_equal(alone.z, found.z[path])
    assert not np.array_equal(fewer.z, fx.ensemble(SCENE, 0.05, 1.0, TS, 2, 4).z)


def test_intervals_hold_the_mean_and_shrink_with_the_number_of_paths():
    few, many = (fx.ensemble(SCENE, 0.05, 1.0, TS, n, 0) for n in (16, 256))
    assert np.all(few.z_low <= few.z_mean)
    assert np.all(few.z_mean <= few.z_high)
    assert many.z_mean.values == pytest.approx(many.z.values.mean(axis=0))
    ratio = (many.z_high - many.z_low)[1:] / (few.z_high - few.z_low)[1:]
    assert float(ratio.mean()) == pytest.approx(0.25, rel=0.3)
    alone = fx.ensemble(SCENE, 0.05, 1.0, TS, 1, 0)
    assert np.all(np.isinf(alone.z_high))


def test_columns_say_what_they_are():
    found = fx.ensemble(SCENE, 0.05, 1.0, None, 2, 0)
    assert found.sizes == {"path": 2, "time": 201}
    assert all(found[name].attrs["long_name"] for name in found.variables)
    assert np.all(found.status == 0)
    assert found.status.attrs["flag_meanings"] == "ok not_finite"
    assert found.attrs["step"] * found.attrs["steps"] == pytest.approx(4.0)


def test_values_are_those_at_the_times_of_steps():
    ts = np.array([0.0, 0.3, 1.7, 4.0])
    found = fx.ensemble(SCENE, 0.05, 1.0, ts, 2, 0)
    at = found.step_time.values
    assert np.all(np.abs(at - ts) <= 0.5 * found.step)
    assert at[[0, -1]] == pytest.approx([0.0, 4.0], rel=1e-12)
    assert at[1] != ts[1]
    assert np.array_equal(fx.ensemble(SCENE, 0.05, 1.0, at[:-1], 2, 0).z, found.z[:, :-1])


def test_effects_on_the_potential_come_first():
    whole, leading = (
        fx.ensemble(scene_with(*effects, NOISE), 0.05, 1.0, TS, 2, 0)
        for effects in ((), (fx.effects.LeadingOrder(),))
    )
    change = np.abs(whole.z - leading.z)[:, 1:]
    assert np.all(change > 0)
    assert np.all(change < 0.2)


@pytest.mark.slow
def test_tips_in_opposite_phases_of_a_sine_follow_the_load():
    """Leading forces cancel, little is left."""
    pair = fx.effects.RigidArray([0.0, 0.5])
    scene = scene_with(pair, fx.effects.LeadingOrder(), NOISE)
    flat = fx.ensemble(scene, 0.05, 1.0, TS, 2, 0)
    spring = flat.z.mean("path") - LOAD(TS)
    assert np.all(np.abs(spring) < 0.2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"scene": scene_with()}, r"scene\.effects = .*needs effects\.Noise among them"),
        (
            {"scene": scene_with(fx.effects.CompliantArray([0.0, 0.5]))},
            "ensemble does not do CompliantArray: needs a bristle at a time",
        ),
        ({"paths": 0}, "paths = 0: needs"),
        ({"paths": 1.5}, "paths = 1.5: needs"),
        ({"key": None}, "key = None: needs a seed"),
        ({"eps": -1.0}, "eps = -1: needs eps > 0"),
        ({"ts": [5.0]}, "ts = .*duration"),
    ],
)
def test_what_cannot_be_done_is_refused_by_name(change, message):
    given = {"scene": SCENE, "eps": 0.05, "gamma": 1.0, "ts": TS, "paths": 2, "key": 0}
    with pytest.raises(ValueError, match=message):
        fx.ensemble(**(given | change))
