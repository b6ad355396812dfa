"""Loads as tables."""

import jax
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.tables import load_table

L = fx.loads
T = np.concatenate([np.linspace(0, 3, 301), [0.5, 1.5, 2.5]])
LOADS = {
    "ramp": L.Ramp(2.0, -0.5),
    "sine": L.Sine(1.3, 2.0),
    "triangle": L.Triangle(1.3, 2.0),
    "points": L.PiecewiseLinear([0.2, 0.9, 2.1], [0.0, 1.0, -1.0]),
    "one point": L.PiecewiseLinear([0.2], [0.7]),
    "many points": L.PiecewiseLinear(np.linspace(0, 3, 50), np.sin(np.arange(50))),
}


@pytest.mark.parametrize("name", LOADS)
def test_a_table_is_the_load_bit_for_bit(name):
    load, table = LOADS[name], load_table(LOADS[name])
    np.testing.assert_array_equal(jax.vmap(table)(T), jax.vmap(load)(T))
    np.testing.assert_array_equal(jax.vmap(table.slope)(T), jax.vmap(load.slope)(T))


def shapes(table):
    return type(table), *(np.shape(leaf) for leaf in jax.tree_util.tree_leaves(table))


def test_two_classes_stand_for_five_and_points_come_in_sizes():
    found = {name: shapes(load_table(load)) for name, load in LOADS.items()}
    assert found["ramp"] == found["sine"] == found["triangle"]
    assert found["points"] == found["one point"] != found["many points"]


def test_functions_stay_themselves():
    load = L.Custom(lambda t: t**2)
    assert load_table(load) is load
