"""Series with a bump of size 0 carry its derivatives wherever they are asked for."""

import jax
import jax.numpy as jnp
import numpy as np

from frictionjax.design.trace.waves import Bumped, WaveProfile

WAVES = WaveProfile(jnp.array([0.002, 0.001]), jnp.array([0.015, -0.003]))
CENTRE, WIDTH = 0.4, 0.1
PHASES = np.concatenate([np.linspace(0.25, 0.55, 13), [1.37, -0.62]])


def test_values_taken_beside_derivatives_move_with_the_bump():
    """As a field takes them: one derivative by y gives the value along."""

    def value_and_slope(size, y):
        profile = Bumped(WAVES, size, CENTRE, WIDTH)
        return jax.jvp(profile, (y,), (jnp.ones_like(y),))

    def by_size(y):
        return jax.jvp(lambda size: value_and_slope(size, y), (0.0,), (1.0,))[1]

    value, slope = jax.jit(jax.vmap(by_size))(PHASES)
    share = ((PHASES - CENTRE + 0.5) % 1 - 0.5) / WIDTH
    inside = np.maximum(1 - share**2, 0.0)
    steepest = 8 * (6 / 7) ** 3 / 7**0.5  # of (1 - u^2)^4, at u^2 = 1/7
    np.testing.assert_allclose(value, WIDTH * inside**4 / steepest, atol=1e-15)
    np.testing.assert_allclose(slope, -8 * share * inside**3 / steepest, atol=1e-13)
