"""Supports take arrays: of each value what they say of it alone."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

SUPPORTS = {
    "spring": fx.supports.Spring(2.0),
    "stiffening": fx.supports.Convex(lambda z: z**2 / 2 + z**4),
}
Z = np.array([[0.0, 0.5], [-1.0, 2.0]])


@pytest.mark.parametrize("support", SUPPORTS.values(), ids=SUPPORTS)
@pytest.mark.parametrize("of", ["force", "stiffness_at", "state_of"])
def test_of_an_array_it_is_what_it_is_of_each(support, of):
    ask = eqx.filter_jit(getattr(support, of))
    alone = [[float(ask(jnp.asarray(z))) for z in row] for row in Z]
    np.testing.assert_allclose(ask(Z), alone, rtol=1e-13)


def test_force_is_that_of_the_formula():
    np.testing.assert_allclose(SUPPORTS["stiffening"].force(Z), Z + 4 * Z**3, rtol=1e-13)
    np.testing.assert_allclose(SUPPORTS["spring"].force(Z), 2 * Z, rtol=1e-13)
