"""Loads as tables."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.model import known_turning_points, padded_edges
from frictionjax.tables import (
    PiecewiseLoad,
    bent_part,
    load_in_pieces,
    load_on_edges,
    load_table,
    straight_part,
)
from frictionjax.tables.fitted_pieces import fitted_pieces

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


def in_pieces(load, duration=3.0):
    load = load.prepared(duration)
    return load_in_pieces(load, known_turning_points(load, duration, 64), duration)


FUNCTIONS = {
    "wave": lambda t: jnp.sin(2 * t) + 0.1 * t,
    "bump": lambda t: t + 0.2 * jnp.exp(-(((t - 1.2) / 0.1) ** 2)),
    "kink": lambda t: jnp.abs(t - 1.0) + 0.3 * t,
    "flat": lambda t: 0.5 + 0.0 * t,
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_are_met_in_pieces_with_slopes_from_the_right(name):
    load = L.Custom(FUNCTIONS[name], [1.0] if name == "kink" else ())
    found = in_pieces(load)
    assert isinstance(found, PiecewiseLoad)
    size = float(np.abs(jax.vmap(load)(T)).max())
    np.testing.assert_allclose(jax.vmap(found)(T), jax.vmap(load)(T), atol=4e-15 * size)
    times = np.append(T, 1.0)
    np.testing.assert_allclose(
        jax.vmap(found.slope)(times), jax.vmap(load.slope)(times), atol=1e-10
    )
    assert bent_part(found) is found


@pytest.mark.parametrize("wide", [1e-4, 1e-2, 0.3])
def test_short_rises_are_met_or_stay_functions(wide):
    load = L.Custom(lambda t: 0.5 * t + 0.05 * jnp.tanh((t - 1.5) / wide))
    found = in_pieces(load)
    times = np.append(T, 1.5 + wide * np.linspace(-5, 5, 101))
    np.testing.assert_allclose(jax.vmap(found)(times), jax.vmap(load)(times), atol=1e-12)
    assert isinstance(found, PiecewiseLoad) == (wide > 1e-3)


def test_pieces_that_say_anything_else_are_not_used(monkeypatch):
    load = L.Custom(FUNCTIONS["wave"])
    assert isinstance(in_pieces(load), PiecewiseLoad)

    def off(fn, edges):
        found = fitted_pieces(fn, edges)
        return found._replace(terms=found.terms * (1 + 1e-9))

    monkeypatch.setattr("frictionjax.tables.loads.fitted_pieces", off)
    assert isinstance(in_pieces(load), L.Custom)


def test_functions_are_of_one_kind_in_pieces_and_so_are_pulled_ends():
    few = [fn for name, fn in FUNCTIONS.items() if name != "bump"]
    kinds = {shapes(in_pieces(L.Custom(fn))) for fn in few}
    pulled = L.Pulled(L.Custom(FUNCTIONS["wave"]), 0.3).held_by(jnp.asarray(1.7), 0.0)
    kinds.add(shapes(in_pieces(pulled)))
    assert len(kinds) == 1


def test_tables_stay_tables_and_what_no_pieces_meet_stays_a_function():
    assert shapes(in_pieces(LOADS["sine"])) == shapes(load_table(LOADS["sine"]))
    bent = L.Custom(lambda t: t + 0.1 * jnp.abs(t - 0.777) ** 1.5)
    assert isinstance(in_pieces(bent), L.Custom)


def test_the_steepest_time_of_a_function_is_told():
    load = L.Custom(FUNCTIONS["bump"]).prepared(3.0)
    assert float(in_pieces(load).steepest) == float(load.steepest)


def on_edges(load, duration=3.0):
    load = load.prepared(duration)
    turns = known_turning_points(load, duration, 64)
    return load_on_edges(load_table(load), padded_edges(turns, duration))


@pytest.mark.parametrize("name", LOADS)
def test_lines_between_edges_are_the_load_with_its_slopes_from_the_right(name):
    load, found = LOADS[name], on_edges(LOADS[name])
    times = np.concatenate([T, found.edges, np.nextafter(found.edges, 9.0)])
    size = np.abs(jax.vmap(load)(times)).max()
    np.testing.assert_allclose(
        jax.vmap(found)(times), jax.vmap(load)(times), atol=4e-15 * max(size, 1.0)
    )
    np.testing.assert_allclose(
        jax.vmap(found.slope)(times), jax.vmap(load.slope)(times), rtol=1e-14, atol=1e-14
    )
    count = found.edges.size - 1
    assert found.turning_count(3.0) == count
    np.testing.assert_array_equal(
        found.turning_points(3.0, count), load.turning_points(np.asarray(3.0), count)
    )


def test_lines_between_edges_are_of_one_kind_whatever_the_load():
    kinds = {shapes(on_edges(LOADS[name])) for name in LOADS if name != "many points"}
    assert len(kinds) == 1


def test_functions_stay_functions_between_edges_and_their_steepest_times_known():
    load = L.Custom(lambda t: jax.numpy.sin(2 * t)).prepared(3.0)
    found = on_edges(load)
    np.testing.assert_allclose(jax.vmap(found)(T), np.sin(2 * T), atol=1e-15)
    assert found.steepest == load.steepest
    assert on_edges(LOADS["sine"]).steepest is None


def shapes(table):
    return type(table), *(np.shape(leaf) for leaf in jax.tree_util.tree_leaves(table))


def test_two_classes_stand_for_five_and_points_come_in_sizes():
    found = {name: shapes(load_table(load)) for name, load in LOADS.items()}
    assert found["ramp"] == found["sine"] == found["triangle"]
    assert found["points"] == found["one point"] != found["many points"]


def test_functions_stay_themselves():
    load = L.Custom(lambda t: t**2)
    assert load_table(load) is load
