"""Which eps give an order: tables, and by what rule one of them is named."""

from frictionjax.cost.order_accuracy import EpsGrid, cheapest_grid
from frictionjax.report import order_cost
from frictionjax.report.job import read_job

# Of the same range end, so that smaller eps confirm none of them.
WIDTHS_AND_SECONDS = (0.3, 0.8), (0.015, 1.0), (0.01, 1.2), (0.005, 1.3)


def test_it_says_by_what_rule_one_grid_is_named(monkeypatch):
    grids = [
        EpsGrid(0.1, 0.001, 6, width, 1.0, seconds, 1 - width, 1 + width, 7)
        for width, seconds in WIDTHS_AND_SECONDS
    ]
    found = cheapest_grid(grids, 0.02)
    monkeypatch.setattr(order_cost, "order_cost", lambda *_: found)
    told = " ".join(order_cost.run_order_cost(read_job(None), 0.02).split())
    assert found.choice.half_width == 0.01  # within a quarter of 1 s
    assert "1.2 s; the range ends here" in told
    assert "that all smaller eps confirm, or that end where the range does" in told
    assert "of the grids within +-0.02 that take at most a quarter longer" in told
    assert told.endswith("the one of the narrowest interval.")
