"""Complete elliptic integrals against SciPy's."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.special import ellipe, ellipk, ellipkm1

from frictionjax.rods import complete_elliptic

M = np.array([-1.0, 0.0, 1e-12, 0.3, 0.826114766, 0.99, 1 - 1e-10])


def test_both_kinds_are_those_of_scipy():
    found = jax.vmap(complete_elliptic)(jnp.asarray(M))
    np.testing.assert_allclose(found.K, ellipk(M), rtol=1e-14)
    np.testing.assert_allclose(found.E, ellipe(M), rtol=2e-15 / (1 - M.max()) ** 0.1)
    assert float(complete_elliptic(jnp.asarray(1 - 2.0**-52)).K) == pytest.approx(
        ellipkm1(2.0**-52), rel=1e-13
    )


def test_small_parameters_keep_their_digits():
    """K - E and E - (1 - m) K as differences would be 0."""
    m = 1e-18
    found = complete_elliptic(jnp.asarray(m))
    assert float(found.short) == pytest.approx(m, rel=1e-15)
    assert float(found.bend) == pytest.approx(m / 2, rel=1e-15)


def test_the_slope_is_the_one_of_theory():
    m = jnp.asarray(0.4)
    found = complete_elliptic(m)
    by_hand = (found.E - 0.6 * found.K) / (2 * 0.4 * 0.6)  # dK/dm
    slope = jax.grad(lambda m: complete_elliptic(m).K)
    assert float(slope(m)) == pytest.approx(float(by_hand), rel=1e-14)
    assert float(slope(jnp.zeros(()))) == pytest.approx(np.pi / 8, rel=1e-15)
