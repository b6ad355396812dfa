"""Studies of rods that turn over: by errors that vanish."""

import numpy as np
import pytest
from rods_that_turn import jumping_scene, turning_scene

import frictionjax as fx

EPS = np.geomspace(0.08, 0.01, 5)


@pytest.fixture(scope="module")
def jumping():
    return fx.study(fx.sweep(jumping_scene(), EPS, [1.0], np.linspace(0, 4, 41)))


def test_where_it_jumps_orders_are_those_of_graphs(jumping):
    orders = jumping.orders.sel(gamma=1.0)
    assert float(orders.order_seen) < 0.1
    assert 0.25 < float(orders.graph_order_seen) < 1
    assert float(orders.dissipation_graph_order_seen) > 0.3
    assert "jumps 2 times" in jumping.orders.attrs["turning"]
    assert "sup errors do not vanish" in jumping.orders.attrs["turning"]
    assert str(orders.graph_law.item()) == "free"
    assert orders.graph_order.attrs["long_name"].endswith("(graph_error)")


def test_of_the_strip_nothing_is_said(jumping):
    assert "strip_order" not in jumping.orders
    assert np.isnan(jumping.orders.C0).all()


def test_where_it_does_not_jump_both_vanish():
    found = fx.study(fx.sweep(turning_scene(), EPS[:4], [1.0], np.linspace(0, 4, 41)))
    assert "does not jump" in found.orders.attrs["turning"]
    orders = found.orders.sel(gamma=1.0)
    assert float(orders.order_seen) > 0.7
    assert float(orders.graph_order_seen) > 0.7
