import numpy as np
from tips_with_mass import RHO

import frictionjax as fx
from frictionjax.called_for import inertia_numbers


def test_beta_of_a_sine():
    potential = fx.potential(
        fx.profiles.Sine(RHO), fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    )
    eps, gamma = np.array([0.1, 0.01]), np.array([1.0, 0.5])
    found = inertia_numbers(potential, fx.effects.Inertia(0.3, 2.0), eps, gamma)
    expected = 0.3 * eps**2 * 2 * np.pi * RHO * eps ** (-1 - 2 * gamma)
    np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_beta_sees_the_bristle_that_leans():
    """`W = alpha w(g^-1)`: its steepest slope is in the state, not under the tip."""
    leaning = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
    profile = fx.profiles.Sine(0.5)
    potential = fx.potential(profile, leaning)
    y = np.linspace(0, 1, 20001)
    a = float(potential.a())
    Y = y + a * np.asarray(profile(y))
    W = float(potential.alpha()) * np.asarray(profile(y))
    bend = np.gradient(np.gradient(W, Y), Y)[3:-3]
    found = inertia_numbers(potential, fx.effects.Inertia(1.0), 1.0, 1.0)
    np.testing.assert_allclose(found, np.max(np.abs(bend)), rtol=1e-3)
