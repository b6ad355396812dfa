"""Random admissible scenes against independent trajectories."""

import math

import by_hand as known
import numpy as np
import pytest
import reference as ref

import frictionjax as fx

TIMES = np.linspace(0.0, 3.0, 61)


def random_bristle(generator, kind):
    """A slanted or angular bristle of the library, and the same written by hand."""
    if kind == "slanted":
        theta = generator.uniform(-0.8, 0.8)
        stiffness = 10 ** generator.uniform(-0.3, 0.5)
        rest = generator.choice([0.5, 1.6]) / math.cos(theta)  # alpha < 0 and > 0
        numbers = (stiffness, rest, 1.0, theta)
        return fx.bristles.SlantedSpring(*numbers), known.slanted(*numbers)
    length = generator.uniform(1.1, 2.0)
    rest_angle = generator.uniform(-0.5, 0.8) * math.acos(1 / length)
    numbers = (generator.uniform(0.5, 3.0), length, 1.0, rest_angle)
    return fx.bristles.AngularSpring(*numbers), known.angular(*numbers)


def random_case(seed, kind):
    generator = np.random.default_rng(seed)
    fall = 0.010 / np.arange(1, 4) ** 1.5
    cos, sin = generator.normal(size=(2, 3)) * fall
    profile = fx.profiles.Fourier(cos, sin)
    bristle, by_hand = random_bristle(generator, kind)
    law = fx.friction(profile, bristle)
    width = float(law.rho_plus - law.rho_minus)
    stiffness = 10 ** generator.uniform(-0.4, 0.7)
    kinks = np.array([0.4, 1.1, 1.9, 2.5]) + generator.uniform(-0.2, 0.2, 4)
    times = np.concatenate([[0.0], kinks, [3.0]])
    values = np.concatenate([[0.0], generator.uniform(-3, 3, 5) * width])
    z0 = generator.choice([0.0, 3.0, -6.0]) * width / stiffness  # in and far outside
    load = fx.loads.PiecewiseLinear(times, values)
    scene = fx.Scene(profile, bristle, fx.supports.Spring(stiffness), load, 3.0, z0)
    system = ref.System(
        w=ref.series(list(cos), list(sin)),
        bristle=by_hand,
        force=lambda z: stiffness * z,
        load=known.piecewise(times, values),
        duration=3.0,
        kinks=tuple(kinks),
        steepest=width / 2,
        stiffness=stiffness,
        rate=float(np.abs(np.diff(values) / np.diff(times)).max()),
    )
    return known.Case(scene, system, generator.uniform(0.5, 2.0), z0)


@pytest.mark.parametrize(
    ("kind", "seed"),
    [
        pytest.param("angular", 0, marks=pytest.mark.slow),
        *(
            pytest.param(kind, seed, marks=pytest.mark.slow)
            for kind in ("slanted", "angular")
            for seed in range(5)
            if (kind, seed) != ("angular", 0)
        ),
    ],
)
def test_accuracy_is_met(kind, seed):
    one = random_case(seed, kind)
    eps = [0.05, 0.02][seed % 2]
    expected = ref.solve(one.system, eps, one.gamma, one.z0, TIMES)
    outside = ~expected.in_slip
    assert outside.sum() >= 50
    for accuracy in (1e-2, 1e-3, 1e-4):
        found = fx.solve(one.scene, eps, one.gamma, TIMES, accuracy=accuracy)
        assert found.ok, found.status.message
        error = np.abs(np.asarray(found.z) - expected.z)[outside] / eps
        assert error.max() < accuracy
        lost = np.abs(np.asarray(found.dissipation) - expected.dissipation)[outside]
        assert lost.max() < accuracy * expected.dissipation[-1]
