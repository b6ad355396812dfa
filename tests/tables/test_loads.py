"""Loads as tables."""

import jax
import numpy as np
import pytest
from at_places import at_places, part_at
from loads_known import LOADS, L, T, shapes, with_slopes

from frictionjax.tables import bent_part, load_table, straight_part


@pytest.mark.parametrize("name", LOADS)
def test_a_table_is_the_load_bit_for_bit(name):
    load, table = LOADS[name], load_table(LOADS[name])
    np.testing.assert_array_equal(with_slopes(table, T), with_slopes(load, T))


@pytest.mark.parametrize("name", LOADS)
def test_parts_of_a_table_add_up_to_the_load(name):
    load = LOADS[name]
    bent, straight = bent_part(load_table(load)), straight_part(load_table(load))
    found = sum(with_slopes(part, T) for part in (bent, straight))
    np.testing.assert_allclose(found, with_slopes(load, T), rtol=1e-15)
    assert isinstance(bent, L.Sine)
    np.testing.assert_array_equal(at_places(jax.grad(straight.slope), T), 0.0)


def test_functions_are_all_bent():
    load = L.Custom(lambda t: t**2)
    assert bent_part(load) is load
    np.testing.assert_array_equal(part_at(straight_part(load), T), 0.0)


@pytest.mark.parametrize("name", LOADS)
def test_a_pulled_load_is_its_position_stretched(name):
    load = L.Pulled(LOADS[name], 0.3).held_by(np.asarray(1.7), np.asarray(-0.4))
    table = load_table(load)
    assert shapes(table) == shapes(load_table(LOADS[name]))
    expected = 1.7 * (np.asarray(part_at(LOADS[name], T)) - 0.7)
    np.testing.assert_allclose(part_at(table, T), expected, atol=1e-14)
    np.testing.assert_allclose(part_at(load, T), expected, atol=1e-14)


def test_two_classes_stand_for_five_and_points_come_in_sizes():
    found = {name: shapes(load_table(load)) for name, load in LOADS.items()}
    assert found["ramp"] == found["sine"] == found["triangle"]
    assert found["points"] == found["one point"] != found["many points"]


def test_functions_stay_themselves():
    load = L.Custom(lambda t: t**2)
    assert load_table(load) is load
