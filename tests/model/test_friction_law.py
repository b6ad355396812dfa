"""The friction law: R."""

import jax.numpy as jnp
import numpy as np

from frictionjax.model.friction_law import dissipation_potential


def test_R_is_positively_homogeneous():
    v = jnp.asarray([-2.0, -1.0, 0.0, 1.0, 3.0])
    found = dissipation_potential(0.3, -0.2, v)
    np.testing.assert_allclose(found, [0.4, 0.2, 0.0, 0.3, 0.9], rtol=1e-15)
