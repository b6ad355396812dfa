"""Threads of the library: as many bits, a core each, and nothing begun after a failure."""

import time

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax._compile import WORKERS, cores, crew, in_background, side_by_side


def bits(_=None):
    return jnp.asarray(1.0).dtype


@pytest.mark.parametrize("wide", [True, False])
def test_threads_have_the_bits_of_who_asks(wide):
    with jax.enable_x64(wide):
        wanted = bits()
        found = [crew("bits").submit(bits).result(), *crew("bits").map(bits, range(3))]
        found += side_by_side("bits", bits, range(3))
        thread = in_background(lambda: found.append(bits()), "bits")
        thread.join()
    assert found == [wanted] * 8
    assert wanted == (np.float64 if wide else np.float32)


def test_a_sweep_within_64_bits_alone():
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.2, 3.0),
        3.0,
    )
    eps = np.geomspace(0.1, 2e-3, 6)
    known = fx.sweep([scene, scene], eps, 1.0)
    jax.config.update("jax_enable_x64", False)
    try:
        with jax.enable_x64(True):
            found = fx.sweep([scene, scene], eps, 1.0)
    finally:
        jax.config.update("jax_enable_x64", True)
    assert np.array_equal(found.z, known.z)


def test_work_side_by_side_has_a_core_each():
    assert cores() == WORKERS
    assert side_by_side("seats", lambda _: cores(), range(4)) == [1] * 4
    assert side_by_side("seats", lambda _: cores(), [0]) == [WORKERS]
    assert cores() == WORKERS


def test_results_come_in_order():
    def late(number):
        time.sleep(0.01 * (number % 2))
        return number

    assert side_by_side("order", late, range(6)) == list(range(6))


def test_nothing_begins_after_a_failure():
    begun = []

    def work(number):
        begun.append(number)
        time.sleep(0.02)
        raise ValueError(f"number {number}")

    with pytest.raises(ValueError, match="number 0"):
        side_by_side("failing", work, range(50))
    time.sleep(0.1)
    assert len(begun) <= 3 * WORKERS
