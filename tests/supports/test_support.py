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


class Mine(fx.supports.AbstractSupport):
    """A support of a class of one's own."""

    def energy(self, z):
        return z**2 / 2

    def state_of(self, force):
        return np.asarray(force)


def test_methods_of_a_class_of_ones_own_that_jax_cannot_trace_are_named():
    with pytest.raises(ValueError, match=r"support: Mine\.state_of = Mine\(\).*jax\.numpy"):
        Mine()
    pair = {"state_of": lambda self, force: force, "energy": lambda self, z: (z, z)}
    with pytest.raises(ValueError, match=r"support: Pair\.energy = .*shape \(2,\)"):
        type("Pair", (Mine,), pair)()
