"""Grids of eps are drawn by time and interval, the confirmed ones filled."""

import pytest

from frictionjax.cost.order_accuracy import EpsGrid, OrderCost

_REST = {"order": 1.0, "low": 0.9, "high": 1.1, "laid": 7}
GRIDS = [
    EpsGrid(0.1, 0.01, 6, 0.3, seconds=0.1, **_REST),
    EpsGrid(0.01, 1e-3, 6, 0.1, seconds=0.2, confirmed=True, **_REST),
    EpsGrid(0.01, 1e-3, 8, 0.2, seconds=0.3, confirmed=True, **_REST),
    EpsGrid(0.01, 1e-4, 8, 0.02, seconds=0.5, confirmed=True, **_REST),
]


def test_points_are_grids_and_the_line_the_front():
    found = OrderCost(GRIDS, GRIDS[3], success=True, message="one")
    (axes,) = found.plot().axes
    confirmed, others, front, choice = (line.get_xydata().tolist() for line in axes.lines)
    assert confirmed == [[0.2, 0.1], [0.3, 0.2], [0.5, 0.02]]
    assert others == [[0.1, 0.3]]
    assert front == [[0.2, 0.1], [0.5, 0.02]]
    assert choice == [[0.5, 0.02]]
    assert axes.get_title(loc="left") == "Grids of eps"


def test_where_no_grid_gives_an_order_nothing_is_drawn():
    none = OrderCost([], None, success=False, message="no grid in this range")
    with pytest.raises(ValueError, match="found = 'no grid in this range': needs grids"):
        none.plot()
    failed = OrderCost(GRIDS[:1], None, success=False, message="")
    (axes,) = failed.plot().axes
    assert axes.get_title(loc="left").endswith("none recommended")
