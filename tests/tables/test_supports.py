"""Supports as power series."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.tables import SeriesSupport, support_table

ENERGIES = {
    "spring": lambda z: 0.7 * z**2,
    "quartic": lambda z: 0.5 * z**2 + 0.3 * z + 0.1 * z**4,
    "exponential": lambda z: 0.4 * z**2 + 0.05 * jnp.exp(z),
}


@eqx.filter_jit
def readings(support, z):
    """Forces, stiffnesses and energies, (n,) each."""
    of = support.force, support.stiffness_at, support.energy
    return [jax.vmap(fn)(z) for fn in of]


@eqx.filter_jit
def states(support, forces):
    return jax.vmap(support.state_of)(forces)


@pytest.mark.parametrize("name", ENERGIES)
@pytest.mark.parametrize(("least", "largest"), [(-1.0, 1.5), (2.0, 2.1)])
def test_a_series_is_the_support_to_rounding_and_somewhat_beyond(name, least, largest):
    support = fx.supports.Convex(ENERGIES[name])
    found = support_table(support, least, largest)
    assert isinstance(found, SeriesSupport)
    more = 0.2 * (largest - least)
    ends = np.asarray(states(support, np.array([least - more, largest + more])))
    assert float(found.low) < ends[0] < ends[1] < float(found.high)
    z = np.linspace(*ends, 101)
    force, stiffness, energy = (np.asarray(each) for each in readings(support, z))
    near = readings(found, z)
    size = np.abs(force).max()
    np.testing.assert_allclose(near[0], force, atol=1e-13 * size)
    np.testing.assert_allclose(near[1], stiffness, rtol=1e-9)
    atol = 1e-14 * np.abs(energy).max() + 1e-13 * size * (ends[1] - ends[0])
    np.testing.assert_allclose(near[2], energy, atol=atol)
    np.testing.assert_allclose(states(found, force), z, atol=1e-12 * np.abs(z).max())
    assert float(found.state_of(force[3])) == pytest.approx(z[3], rel=1e-11)


def test_supports_are_of_one_kind():
    kinds = set()
    for energy in ENERGIES.values():
        found = support_table(fx.supports.Convex(energy), -1.0, 1.0)
        kinds.add(tuple(np.shape(leaf) for leaf in jax.tree_util.tree_leaves(found)))
    assert len(kinds) == 1


@pytest.mark.parametrize(
    "energy",
    [
        lambda z: 0.5 * z**2 + 0.1 * jnp.abs(z) ** 2.5,
        lambda z: z**2 + 0.01 * jnp.log(jnp.cosh(100 * z)),
    ],
    ids=["bent at 0", "bends fast"],
)
def test_what_no_series_meets_stays_as_it_is(energy):
    support = fx.supports.Convex(energy)
    assert support_table(support, -4.0, 4.0) is support


def test_forces_of_a_point_have_no_series():
    support = fx.supports.Convex(ENERGIES["quartic"])
    assert support_table(support, 0.5, 0.5) is support
