import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.effects import AbstractEffect, Noise


def test_temperature_falls_with_its_power_of_eps():
    noise = Noise(0.02, exponent=1.5)
    assert isinstance(noise, AbstractEffect)
    eps = np.array([1.0, 0.1, 0.01])
    assert np.allclose(noise.temperature_at(eps), [0.02, 0.02 * 0.1**1.5, 2e-5])
    assert float(Noise(0.02).temperature_at(0.1)) == pytest.approx(2e-3)


@pytest.mark.parametrize("wrong", [0.0, -1.0, np.nan, np.inf, "hot", [1.0, 2.0], True])
def test_a_temperature_is_one_positive_number(wrong):
    with pytest.raises(
        ValueError, match=r"effects\.Noise\.temperature = .*temperature > 0 in J"
    ):
        Noise(wrong)


@pytest.mark.parametrize("wrong", [np.nan, np.inf, "one", [1.0]])
def test_an_exponent_is_one_finite_number(wrong):
    with pytest.raises(
        ValueError, match=r"effects\.Noise\.exponent = .*any exponent of eps"
    ):
        Noise(1.0, wrong)


def test_numbers_can_be_exchanged():
    noise = Noise(1.0).replace(exponent=2.0)
    assert noise.exponent == 2
    assert noise.temperature == 1
    assert isinstance(noise.temperature, jnp.ndarray)
