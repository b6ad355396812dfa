"""Loads given as functions, as polynomials on pieces."""

import jax.numpy as jnp
import numpy as np
import pytest
from at_places import at_places
from loads_known import L, T, shapes, with_slopes

from frictionjax.model import known_turning_points
from frictionjax.tables import (
    PiecewiseLoad,
    bent_part,
    load_in_pieces,
    load_table,
)
from frictionjax.tables.fitted_pieces import fitted_pieces


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
    times = np.append(T, 1.0)
    (values, slopes), expected = with_slopes(found, times), with_slopes(load, times)
    size = float(np.abs(expected[0]).max())
    np.testing.assert_allclose(values, expected[0], atol=4e-15 * size)
    np.testing.assert_allclose(slopes, expected[1], atol=1e-10)
    assert bent_part(found) is found


@pytest.mark.parametrize("wide", [1e-6, 1e-4, 1e-2, 0.3])
def test_short_rises_are_met_or_stay_functions(wide):
    load = L.Custom(lambda t: 0.5 * t + 0.05 * jnp.tanh((t - 1.5) / wide))
    found = in_pieces(load)
    times = np.append(T, 1.5 + wide * np.linspace(-5, 5, 101))
    np.testing.assert_allclose(at_places(found, times), at_places(load, times), atol=1e-12)
    assert isinstance(found, PiecewiseLoad) == (wide > 1e-5)


def test_pieces_that_say_anything_else_are_not_used(monkeypatch):
    load = L.Custom(FUNCTIONS["wave"])
    assert isinstance(in_pieces(load), PiecewiseLoad)

    def off(fn, edges):
        found = fitted_pieces(fn, edges)
        return found._replace(terms=found.terms * (1 + 1e-9))

    monkeypatch.setattr("frictionjax.tables.piecewise_loads.fitted_pieces", off)
    assert isinstance(in_pieces(load), L.Custom)


def test_functions_are_of_one_kind_in_pieces_and_so_are_pulled_ends():
    few = [fn for name, fn in FUNCTIONS.items() if name != "bump"]
    kinds = {shapes(in_pieces(L.Custom(fn))) for fn in few}
    pulled = L.Pulled(L.Custom(FUNCTIONS["wave"]), 0.3).held_by(jnp.asarray(1.7), 0.0)
    kinds.add(shapes(in_pieces(pulled)))
    assert len(kinds) == 1


def test_tables_stay_tables_and_what_no_pieces_meet_stays_a_function():
    sine = L.Sine(1.3, 2.0)
    assert shapes(in_pieces(sine)) == shapes(load_table(sine))
    bent = L.Custom(lambda t: t + 0.1 * jnp.abs(t - 0.777) ** 1.5)
    assert isinstance(in_pieces(bent), L.Custom)


def test_the_steepest_time_of_a_function_is_told():
    load = L.Custom(FUNCTIONS["bump"]).prepared(3.0)
    assert float(in_pieces(load).steepest) == float(load.steepest)
