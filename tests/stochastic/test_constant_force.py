import numpy as np
import pytest
from noisy_wells import COSINE, SLANTED
from scipy.special import i0

import frictionjax as fx
from frictionjax.stochastic import diffusion_ratio, mean_speed

UNIT = {"eps": 1.0, "viscosity": 1.0}


@pytest.mark.parametrize(
    ("force", "temperature", "speed"),
    [(0.05, 0.01, 0.0230070369), (0.12, 0.001, 0.0680849606)],
)
def test_mean_speed_is_that_of_the_closed_form(force, temperature, speed):
    found = mean_speed(COSINE, [force, -force, 0], temperature=temperature, **UNIT)
    assert found == pytest.approx([speed, -speed, 0.0], abs=1e-10)


def test_speed_and_diffusion_scale_with_their_units():
    """Lengths, forces, viscosity: wells of the same shape are as deep as eps."""
    small = mean_speed(COSINE, 0.05, eps=0.01, viscosity=0.2, temperature=1e-4)
    assert small == pytest.approx(0.0230070369 / 0.2, rel=1e-8)


@pytest.mark.parametrize("ratio", [1.0, 2.0])
def test_diffusion_over_a_sine_is_a_bessel_function(ratio):
    temperature = 0.1 / (2 * np.pi) / ratio
    found = diffusion_ratio(COSINE, eps=1.0, temperature=temperature)
    assert found == pytest.approx({1.0: 0.6238603604, 2.0: 0.1924368785}[ratio], abs=1e-10)
    assert found == pytest.approx(1 / i0(ratio) ** 2, rel=1e-12)


def test_a_small_force_moves_as_diffusion_says():
    """Einstein's relation, on wells that are no sine and not symmetric."""
    bath = {"eps": 0.05, "temperature": 3e-3}
    diffusion = diffusion_ratio(SLANTED, **bath)
    force = 1e-5 * bath["temperature"] / bath["eps"]
    speeds = mean_speed(SLANTED, [force, -force], viscosity=1.0, **bath)
    assert speeds == pytest.approx([diffusion * force, -diffusion * force], rel=1e-5)


def test_cold_tips_creep_by_kramers_rate_and_slide_as_without_noise():
    """Barriers of 80 T: nothing overflows, no digit is lost; U'' = 2 pi rho/eps."""
    temperature = 0.1 / np.pi / 80
    creep = mean_speed(COSINE, 1e-4, temperature=temperature, **UNIT)
    hops = 0.1 * np.exp(-80) * 2 * np.sinh(0.5e-4 / temperature)
    assert creep == pytest.approx(hops, rel=0.02)
    slide = mean_speed(COSINE, 0.2, temperature=1e-5, **UNIT)
    assert slide == pytest.approx(np.sqrt(0.2**2 - 0.1**2), rel=1e-4)


def test_directions_differ_where_the_wells_lean():
    found = mean_speed(SLANTED, [0.2, -0.2], eps=0.05, viscosity=0.05, temperature=1e-3)
    assert -found[1] > 2.5 * found[0] > 0
    mirror = fx.potential(
        fx.profiles.Sine(0.4), fx.bristles.SlantedSpring(1.0, 2.2, 1.0, -0.9)
    )
    other = mean_speed(mirror, [-0.2, 0.2], eps=0.05, viscosity=0.05, temperature=1e-3)
    assert other == pytest.approx(-found, rel=1e-10)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"eps": 0.0}, "eps = 0: needs eps > 0"),
        ({"viscosity": -1.0}, "viscosity = -1: needs"),
        ({"temperature": 0.0}, "temperature = 0: needs"),
        ({"temperature": 1e-9}, r"temperature = 1e-09: needs temperature >= .* for these"),
        ({"forces": [np.nan]}, "forces = .*finite numbers in N"),
    ],
)
def test_numbers_out_of_range_are_named(change, message):
    given = {"forces": 0.1, "temperature": 0.1} | UNIT | change
    with pytest.raises(ValueError, match=message):
        mean_speed(COSINE, **given)
