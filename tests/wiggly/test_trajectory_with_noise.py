import jax
import numpy as np
import pytest
from noisy_wells import SLANTED

import frictionjax as fx

PARTS = SLANTED.profile, SLANTED.bristle, fx.supports.Spring(1.0), fx.loads.Triangle(1.5, 4)
PLAIN = fx.Scene(*PARTS, 4.0)
NOISY = PLAIN.replace(effects=(fx.effects.Noise(0.02),))
TS = np.linspace(0.0, 4.0, 41)


def test_a_path_follows_from_its_key():
    found = fx.solve(NOISY, 0.05, 1.0, TS, key=7)
    assert found.ok
    assert np.array_equal(found.z, fx.solve(NOISY, 0.05, 1.0, TS, key=jax.random.key(7)).z)
    assert not np.array_equal(found.z, fx.solve(NOISY, 0.05, 1.0, TS, key=8).z)
    assert found.z[0] == NOISY.z0
    assert found.dissipation is None
    assert found.stats["step"] * found.stats["steps"] == pytest.approx(4.0)


@pytest.mark.slow
def test_a_cold_path_is_near_the_trajectory():
    cold = NOISY.replace(effects=(fx.effects.Noise(1e-9),))
    found, exact = fx.solve(cold, 0.05, 1.0, TS, key=0), fx.solve(PLAIN, 0.05, 1.0, TS)
    assert np.median(np.abs(found.z - exact.z)) < 0.05 * 0.05


@pytest.mark.parametrize(
    ("scene", "given", "message"),
    [
        (NOISY, {}, "key = None: needs a seed"),
        (NOISY, {"key": -1}, "key = -1: needs"),
        (NOISY, {"key": 0.5}, "key = 0.5: needs a seed"),
        (PLAIN, {"key": 0}, r"key = 0: needs None, or a scene with effects\.Noise"),
        (NOISY, {"key": 0, "accuracy": 1e-4}, "accuracy = 0.0001: needs its default"),
        (NOISY, {"key": 0, "max_steps": 10}, "max_steps = 10: needs its default"),
        (NOISY, {"key": 0, "method": "Kvaerno5"}, "does not do Noise: needs method"),
    ],
)
def test_what_cannot_be_done_is_refused_by_name(scene, given, message):
    with pytest.raises(ValueError, match=message):
        fx.solve(scene, 0.05, 1.0, TS, **given)


def test_paths_have_no_derivatives_and_say_so():
    with pytest.raises(ValueError, match="known ones"):
        jax.grad(lambda e: fx.solve(NOISY, e, 1.0, TS, key=0).z[-1])(0.05)
