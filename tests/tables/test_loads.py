"""Loads as tables."""

import jax
import numpy as np
import pytest
from loads_known import LOADS, L, T, shapes

from frictionjax.tables import bent_part, load_table, straight_part


@pytest.mark.parametrize("name", LOADS)
def test_a_table_is_the_load_bit_for_bit(name):
    load, table = LOADS[name], load_table(LOADS[name])
    np.testing.assert_array_equal(jax.vmap(table)(T), jax.vmap(load)(T))
    np.testing.assert_array_equal(jax.vmap(table.slope)(T), jax.vmap(load.slope)(T))


@pytest.mark.parametrize("name", LOADS)
def test_parts_of_a_table_add_up_to_the_load(name):
    load = LOADS[name]
    bent, straight = bent_part(load_table(load)), straight_part(load_table(load))
    for method in ("__call__", "slope"):
        found = (jax.vmap(getattr(part, method))(T) for part in (bent, straight))
        expected = jax.vmap(getattr(load, method))(T)
        np.testing.assert_allclose(sum(found), expected, rtol=1e-15)
    assert isinstance(bent, L.Sine)
    flat = jax.vmap(jax.grad(straight.slope))(T)
    np.testing.assert_array_equal(flat, 0.0)


def test_functions_are_all_bent():
    load = L.Custom(lambda t: t**2)
    assert bent_part(load) is load
    np.testing.assert_array_equal(jax.vmap(straight_part(load))(T), 0.0)


@pytest.mark.parametrize("name", LOADS)
def test_a_pulled_load_is_its_position_stretched(name):
    load = L.Pulled(LOADS[name], 0.3).held_by(np.asarray(1.7), np.asarray(-0.4))
    table = load_table(load)
    assert shapes(table) == shapes(load_table(LOADS[name]))
    expected = 1.7 * (jax.vmap(LOADS[name])(T) - 0.7)
    np.testing.assert_allclose(jax.vmap(table)(T), expected, atol=1e-14)
    np.testing.assert_allclose(jax.vmap(load)(T), expected, atol=1e-14)


def test_two_classes_stand_for_five_and_points_come_in_sizes():
    found = {name: shapes(load_table(load)) for name, load in LOADS.items()}
    assert found["ramp"] == found["sine"] == found["triangle"]
    assert found["points"] == found["one point"] != found["many points"]


def test_functions_stay_themselves():
    load = L.Custom(lambda t: t**2)
    assert load_table(load) is load
