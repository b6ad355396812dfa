"""What paths know of physics, each time against a number from elsewhere."""

import jax.numpy as jnp
import numpy as np
import pytest
from noisy_wells import (
    ANGLE,
    COSINE,
    EPS,
    RHO,
    SLANTED,
    SLOPE,
    Free,
    boltzmann_mean,
    boltzmann_samples,
    cosine_energy,
)
from scipy.integrate import solve_ivp

import frictionjax as fx
from frictionjax.stochastic import NoisyCell, path_keys, path_steps, run_paths
from frictionjax.stochastic.settings import SETTINGS

SPRING = fx.supports.Spring(1.0)
GRID = np.linspace(-0.6, 0.6, 24001)


def cell(potential=COSINE, support=SPRING, load=None, **numbers):
    bath = {"eps": EPS, "viscosity": 1.0, "temperature": 2e-4, "duration": 50.0} | numbers
    return NoisyCell(potential, support, load or fx.loads.Ramp(0.0), **bath)


@pytest.fixture
def long_steps(monkeypatch):
    """Of means at rest: `settings.py`."""
    long = SETTINGS._replace(step_curvature=0.25)
    monkeypatch.setattr(path_steps, "SETTINGS", long)


def settled(found, start):
    return found.z[:, found.ts > start]


def test_a_pinned_tip_has_boltzmanns_moments(long_steps):
    """A temperature 2% off changes both by 2%: eight standard errors."""
    energy = cosine_energy(GRID)
    exact = [
        boltzmann_mean(f, energy, 2e-4) for f in (GRID**2, np.cos(2 * np.pi * GRID / EPS))
    ]
    assert exact == pytest.approx([2.889234275e-5, 0.944623722903], rel=1e-9)
    ts = np.arange(0.0, 50.0, 0.4)
    found = run_paths(cell(), ts, path_keys(7, 2400), np.zeros(2400))
    z = settled(found, 2.0)
    assert np.mean(z**2) == pytest.approx(exact[0], rel=0.01)
    swing = 1 - np.cos(2 * np.pi * z / EPS)
    assert np.mean(swing) == pytest.approx(1 - exact[1], rel=0.01)
    assert np.mean(z) == pytest.approx(0.0, abs=5e-5)


def test_a_slanted_bristle_has_boltzmanns_density_in_z(long_steps):
    """G is between 1/2 and 3/2: a density in the tip's coordinate would be 40% off.

    Exact means are integrals over the tip, `dz = eps G dy`, in closed form.
    """
    temperature = 5e-3
    y = np.linspace(-8, 8, 64001)
    height = EPS * SLOPE / (2 * np.pi) * np.sin(2 * np.pi * y)
    slope = SLOPE * np.cos(2 * np.pi * y)
    z, stretch = EPS * y - height * np.tan(ANGLE), 1 - np.tan(ANGLE) * slope
    length = (1 - height) / np.cos(ANGLE)
    energy = 0.5 * (2.2 - length) ** 2 + 0.5 * z**2
    ts = np.arange(0.0, 40.0, 0.4)
    numbers = {"temperature": temperature, "viscosity": 0.1, "duration": 40.0}
    found = run_paths(cell(SLANTED, **numbers), ts, path_keys(8, 1600), np.zeros(1600))
    paths = settled(found, 4.0)
    for fn in (np.cos, np.sin, lambda turn: np.cos(2 * turn)):
        weighed = boltzmann_mean(fn(2 * np.pi * z / EPS), energy, temperature, stretch)
        in_y = boltzmann_mean(fn(2 * np.pi * z / EPS), energy, temperature)
        seen = np.mean(fn(2 * np.pi * paths / EPS))
        assert seen == pytest.approx(weighed, abs=0.01)
        assert abs(seen - in_y) > 0.02
    assert np.mean(paths**2) == pytest.approx(
        boltzmann_mean(z**2, energy, temperature, stretch), rel=0.02
    )


@pytest.mark.parametrize("ratio", [1.0, pytest.param(2.0, marks=pytest.mark.slow)])
def test_free_tips_diffuse_as_lifson_and_jackson_say(ratio):
    temperature = EPS * RHO / (2 * np.pi) / ratio
    free = EPS**2 / temperature  # s to diffuse over a period
    duration = 180 * free
    ts = np.linspace(0.0, duration, 31)
    given = cell(support=Free(), temperature=temperature, duration=duration)
    found = run_paths(given, ts, path_keys(9, 480), np.zeros(480))
    steps = np.diff(found.z[:, 1:], axis=1)
    diffusion = np.mean(steps**2) / (2 * ts[1] * temperature)
    assert diffusion == pytest.approx(
        {1.0: 0.6238603604, 2.0: 0.1924368785}[ratio], rel=0.05
    )


def test_the_first_steps_diffuse_as_the_others():
    """Half a step of noise was missing: a sixth of the variance after three steps."""
    flat = fx.GivenPotential(lambda y: 1e-9 * jnp.sin(2 * jnp.pi * y))
    heat = {"temperature": 0.05, "duration": 0.1}
    step = path_steps.SETTINGS.step_diffusion**2 * EPS**2 / (2 * heat["temperature"])
    ts = step * np.array([1, 3, 10, 30])
    found = run_paths(cell(flat, **heat), ts, path_keys(3, 40_000), np.zeros(40_000))
    assert found.step == pytest.approx(step, rel=0.01)
    exact = heat["temperature"] * -np.expm1(-2 * ts)  # Ornstein and Uhlenbeck
    assert np.var(found.z, axis=0) / exact == pytest.approx(np.ones(4), abs=0.02)


@pytest.mark.slow  # 160,000 paths twice
def test_work_obeys_jarzynskis_equality(monkeypatch):
    """Dragged by a period, irreversibly: the mean work is above. So does a bath that is
    2% too warm, which is seen."""
    temperature, speed, count = 3e-3, 0.02, 160_000
    longer = SETTINGS._replace(step_curvature=0.1)
    monkeypatch.setattr(path_steps, "SETTINGS", longer)
    start = boltzmann_samples(cosine_energy(GRID), GRID, temperature, count)
    ts = np.array([0.0, EPS / speed])
    means = []
    for bath in (temperature, 1.02 * temperature):
        given = cell(load=fx.loads.Ramp(speed), temperature=bath, duration=EPS / speed)
        found = run_paths(given, ts, path_keys(10, count), start)
        gained = found.work[:, -1] + 0.5 * EPS**2  # free energy of the load at its ends
        weights = np.exp(-gained / temperature)
        means.append(np.mean(weights))
        error = np.std(weights) / np.sqrt(count)
        assert np.mean(gained) > 0.5 * temperature
        assert np.all(found.work[:, 0] == 0)
    assert error < 0.0065
    assert means[0] == pytest.approx(1.0, abs=2 * error)
    assert means[1] > 1 + 2 * error


def test_mean_force_of_paths_is_that_of_the_density():
    """Smoluchowski's equation at 1e-4 J and 0.01 m/s: 0.06148 N less drag."""
    given = cell(load=fx.loads.Ramp(0.01), temperature=1e-4, duration=40.0)
    ts = np.arange(20.0, 40.0, 0.1)  # two periods
    found = run_paths(given, ts, path_keys(11, 480), np.zeros(480))
    means = np.mean(0.01 * ts - found.z, axis=1) - 0.01
    error = np.std(means) / np.sqrt(means.size)
    assert error < 3e-4
    assert np.mean(means) == pytest.approx(0.06148, abs=4 * error)


def test_without_heat_a_path_is_the_trajectory():
    given = cell(load=fx.loads.Sine(0.3, 40.0), temperature=1e-18, duration=40.0)
    ts = np.linspace(0.0, 40.0, 41)
    found = run_paths(given, ts, path_keys(1, 1), np.zeros(1))

    def velocity(t, z):
        pull = 0.3 * np.sin(2 * np.pi * t / 40.0)
        return pull - z - RHO * np.sin(2 * np.pi * z / EPS)

    exact = solve_ivp(velocity, (0, 40.0), [0.0], "LSODA", ts, rtol=1e-9, atol=1e-12).y[0]
    assert np.median(np.abs(found.z[0] - exact)) < 0.002 * EPS
    assert np.max(np.abs(found.z[0] - exact)) < 0.2 * EPS  # inside slips


def test_paths_of_one_key_keep_their_order_and_meet():
    """From 25 wells apart, to the last bit."""
    given = cell(duration=60.0, temperature=1e-3)
    ts = np.linspace(0.0, 60.0, 121)
    keys = path_keys(2, 64)
    lower = run_paths(given, ts, keys, np.full(64, -1.25))
    upper = run_paths(given, ts, keys, np.full(64, 1.25))
    assert np.all(lower.z <= upper.z + 1e-16)  # rounding, where they have met
    assert np.array_equal(lower.z[:, -1], upper.z[:, -1])
    assert np.std(lower.z[:, -1]) > 0.01
