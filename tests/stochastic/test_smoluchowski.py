import numpy as np
import pytest
from noisy_wells import COSINE, EPS, SLANTED
from spectral_density import spectral_friction

import frictionjax as fx
from frictionjax.stochastic import (
    SmoluchowskiStatus,
    diffusion_ratio,
    fixed_point,
    mean_speed,
    smoluchowski_friction,
)
from frictionjax.stochastic import smoluchowski as module
from frictionjax.stochastic.settings import SETTINGS

SPRING = fx.supports.Spring(1.0)
SPEEDS = np.array([1e-4, 1e-3, 1e-2])
KNOWN = {1e-5: [0.06185, 0.06474, 0.06782], 1e-4: [0.04361, 0.05264, 0.06148]}
SPECTRAL = {
    1e-5: {"cells": 160, "box": (-1.3, 1.2)},
    1e-4: {"cells": 64, "box": (-1.9, 1.8)},
}


def friction(speeds, temperature, potential=COSINE, support=SPRING, **bath):
    bath = {"eps": EPS, "viscosity": 1.0, "temperature": temperature} | bath
    return smoluchowski_friction(potential, support, speeds, **bath)


@pytest.mark.parametrize("temperature", [pytest.param(1e-5, marks=pytest.mark.slow), 1e-4])
def test_friction_is_the_known_one_and_that_of_a_spectral_method(temperature):
    found = friction(SPEEDS, temperature)
    assert np.all(found.ok)
    assert np.all(found.error <= SETTINGS.accuracy * 0.1)
    assert found.friction_force == pytest.approx(KNOWN[temperature], abs=3e-5)
    assert found.drag == pytest.approx(SPEEDS)
    assert found.mean_force == pytest.approx(found.friction_force + SPEEDS, rel=1e-12)
    again = [
        spectral_friction(v, temperature, steps=96, rounds=3, **SPECTRAL[temperature])
        for v in SPEEDS
    ]
    assert np.all(np.abs(found.friction_force - again) <= np.maximum(3e-6, found.error))


def test_errors_hold_the_error_and_follow_the_accuracy():
    exact = friction(1e-3, 1e-4, accuracy=5e-6)
    assert exact.error <= 5e-7
    for accuracy in (1e-3, 1e-4, 1e-5):
        found = friction(1e-3, 1e-4, accuracy=accuracy)
        assert found.ok
        assert found.error <= 0.1 * accuracy
        assert abs(found.mean_force - exact.mean_force) <= found.error


def test_negative_speeds_are_the_mirror_image():
    found = friction([1e-3, 0.0, -1e-3], 1e-4)
    right, rest, left = found.friction_force
    assert left == pytest.approx(-right, rel=1e-12)
    assert rest == 0
    assert found.error[1] == 0
    mirror = fx.potential(
        fx.profiles.Sine(0.4), fx.bristles.SlantedSpring(1.0, 2.2, 1.0, -0.9)
    )
    bath = {"eps": 0.05, "viscosity": 0.05}
    leaning = friction([0.02, -0.02], 1e-4, SLANTED, **bath).friction_force
    other = friction([-0.02, 0.02], 1e-4, mirror, **bath).friction_force
    assert other == pytest.approx(-leaning, abs=1e-6)
    assert leaning[0] > -1.5 * leaning[1] > 0


@pytest.mark.slow
def test_soft_springs_move_as_a_constant_force_does():
    """Ambegaokar and Halperin's speed at the mean force; corrections go like k."""
    speed = float(mean_speed(COSINE, 0.05, eps=EPS, viscosity=1.0, temperature=1e-3))
    soft, softer = (
        friction(speed, 1e-3, support=fx.supports.Spring(k)).mean_force for k in (0.2, 0.1)
    )
    assert 2 * softer - soft == pytest.approx(0.05, rel=5e-4)


def test_hot_tips_feel_a_viscosity_that_diffusion_tells():
    """Slow: friction is in proportion to speed; far above the wells' depth."""
    found = friction(1e-6, 1e-2, support=fx.supports.Spring(0.1), accuracy=1e-7)
    ratio = diffusion_ratio(COSINE, eps=EPS, temperature=1e-2)
    assert found.mean_force / 1e-6 == pytest.approx(1 / ratio, rel=5e-4)


@pytest.mark.slow
def test_cold_slides_have_the_friction_of_the_limit():
    """Small eps, little noise, a soft spring: rho, less half of what it loses in a slip."""
    spring = fx.supports.Spring(0.25)
    bath = {"eps": 0.02, "viscosity": 0.02}
    found = friction([1e-3, -1e-3], 1e-7, support=spring, **bath)
    assert np.all(found.ok)
    assert np.abs(found.friction_force) == pytest.approx(0.1 - 0.0025, rel=0.01)


@pytest.mark.parametrize(
    ("setting", "speed", "status"),
    [
        ({"most_work": 100}, 1e-3, SmoluchowskiStatus.TOO_MANY_CELLS),
        ({"grids": 2}, 1e-3, SmoluchowskiStatus.ROUGH_GRID),
        ({"most_periods": 3}, 0.1, SmoluchowskiStatus.NOT_PERIODIC),
        ({}, 1e-14, SmoluchowskiStatus.LOST_MASS),
    ],
)
def test_what_cannot_be_trusted_has_a_status(monkeypatch, setting, speed, status):
    for place in (module, fixed_point):
        monkeypatch.setattr(place, "SETTINGS", SETTINGS._replace(**setting))
    found = friction(speed, 1e-4, accuracy=1e-7)
    assert found.status == status
    assert not found.ok
    assert status.message in str(found.message)
    assert not found.error < 1e-8


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"support": fx.supports.Convex(lambda z: z**2)},
            "support = 'Convex': needs a Spr",
        ),
        ({"speeds": [1.0, np.inf]}, "speeds = .*finite numbers in m/s"),
        ({"eps": -1.0}, "eps = -1: needs eps > 0"),
        ({"viscosity": 0.0}, "viscosity = 0: needs"),
        ({"temperature": 0.0}, "temperature = 0: needs"),
        ({"accuracy": 0.0}, "accuracy = 0: needs"),
    ],
)
def test_numbers_out_of_range_are_named(change, message):
    given = {"speeds": 0.1, "temperature": 0.1} | change
    with pytest.raises(ValueError, match=message):
        friction(**given)


@pytest.mark.parametrize(
    ("speed", "temperature"), [(1e5, 1e-4), (1e300, 1e-4), (1e-3, 1e-13), (1e-3, 5e-324)]
)
def test_too_many_cells_are_told_before_they_are_made(monkeypatch, speed, temperature):
    guess = module._first_guess

    def within_work(wells, drive, window, count):
        assert SETTINGS.steps * count * window.periods <= SETTINGS.most_work
        return guess(wells, drive, window, count)

    monkeypatch.setattr(module, "_first_guess", within_work)
    found = friction(speed, temperature)
    assert found.status == SmoluchowskiStatus.TOO_MANY_CELLS
    assert np.isnan(found.mean_force)


@pytest.mark.parametrize(
    ("most", "status"),
    [
        (600_000, SmoluchowskiStatus.NOT_PERIODIC),
        (1_000_000, SmoluchowskiStatus.ROUGH_GRID),
        (2_400_000, SmoluchowskiStatus.ROUGH_GRID),
    ],
)
def test_work_of_all_grids_together_has_an_end(monkeypatch, most, status):
    """A first grid cut short has no error; a third, not begun or cut, changes nothing."""
    spent = []
    march = fixed_point.march_period

    def noted(density, rises, first, steps, drive):
        spent.append(density.size * steps)
        return march(density, rises, first, steps, drive)

    monkeypatch.setattr(fixed_point, "march_period", noted)
    monkeypatch.setattr(module, "SETTINGS", SETTINGS._replace(most_marched=most))
    found = friction(0.1, 1e-4, accuracy=1e-9)
    assert found.status == status
    assert sum(spent) <= most
    assert np.isfinite(found.error) == (status == SmoluchowskiStatus.ROUGH_GRID)
