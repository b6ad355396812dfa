"""Searches along one number, on quantities that are known by formula."""

import numpy as np
import pytest

from frictionjax.design.slide.scan import (
    Scan,
    crossings,
    scan_slides,
    sliding,
    touching,
)


class Known:
    """A quantity by its formula, which counts how often its slope is asked for."""

    def __init__(self, formula, slope):
        self.formula, self._slope, self.calls = formula, slope, 0

    def __call__(self, places):
        return np.array([self.formula(x) for x in places], dtype=float)

    def slope(self, x):
        self.calls += 1
        return float(self._slope(x))

    def gap(self, target):
        return lambda x: float(self.formula(x)) - target


HUMP = Known(lambda x: 1 - (x - 0.513) ** 2, lambda x: -2 * (x - 0.513))


def test_a_maximum_between_nodes_is_reached_on_both_sides():
    """At 0.513 of 33 even nodes: the highest of them is 1.7e-4 below."""
    found = scan_slides(HUMP, HUMP.slope, 0.0, 1.0)
    assert found.reach[1] == pytest.approx(1.0, abs=1e-12)
    target = 1 - 1e-8
    roots = crossings(HUMP.gap(target), found, target)
    np.testing.assert_allclose(roots, [0.513 - 1e-4, 0.513 + 1e-4], atol=1e-9)
    assert crossings(HUMP.gap(1.1), found, 1.1).size == 0


def test_a_target_at_the_turn_itself_touches():
    found = scan_slides(HUMP, HUMP.slope, 0.0, 1.0)
    assert touching(found, 1.0)[0] == pytest.approx(0.513, abs=1e-6)
    assert touching(found, 1.0 + 1e-8).size == 0
    assert touching(found, float(HUMP.formula(0.25))).size == 0  # a node, but no turn


def test_rounding_is_no_turn():
    flat = Known(lambda x: 1 + 1e-13 * np.sin(1e5 * x), lambda x: 0.0)
    found = scan_slides(flat, flat.slope, 0.0, 1.0)
    assert found.nodes.size == 43
    assert flat.calls == 0


def test_a_step_is_no_turn_either():
    """No slope of another sign on its other side: nodes stand for themselves."""
    step = Known(lambda x: 10 * (x > 0.5) - x, lambda x: -1.0)
    found = scan_slides(step, step.slope, 0.0, 1.0)
    assert found.nodes.size == 43
    assert np.all(np.diff(found.nodes) > 0)


def test_parts_that_slide_are_found_to_rounding():
    def follows(x):
        return (np.abs(x - 1 / 3) < 0.1) | (x > np.pi / 4)

    parts = sliding(follows, 0.0, 1.0)
    np.testing.assert_allclose(
        parts, [(1 / 3 - 0.1, 1 / 3 + 0.1), (np.pi / 4, 1.0)], rtol=1e-15
    )
    assert all(follows(np.array(ends)).all() for ends in parts)
    assert sliding(lambda x: x > 2, 0.0, 1.0) == []
    assert sliding(lambda x: x < 2, 0.0, 1.0) == [(0.0, 1.0)]


@pytest.mark.parametrize("mirrored", [False, True])
def test_an_end_that_was_not_evaluated_is_open_where_values_grow_to_it(mirrored):
    """1/x to a pole may go on to any target above; x^2 has settled, below as above."""

    def lost_at(formula):
        def known(x):
            return np.nan if x < 5e-6 else formula(x)

        turned = Known((lambda x: known(1 - x)) if mirrored else known, lambda x: np.nan)
        return scan_slides(turned, turned.slope, 0.0, 1.0)

    pole = lost_at(lambda x: 1 / x)
    assert pole.failed(1e9).size == 2  # 0 and 1e-6
    assert pole.failed(-1.0).size == 0
    smooth = lost_at(lambda x: x**2)
    assert smooth.failed(-1.0).size == 0
    assert smooth.failed(2.0).size == 0
    assert smooth.known


def test_what_was_not_evaluated_inside_is_always_open():
    nodes = np.linspace(0, 1, 5)
    none = np.zeros(5, bool)
    found = Scan(nodes, np.array([0.0, 1.0, np.nan, 3.0, 4.0]), none)
    np.testing.assert_array_equal(found.failed(9.0), [0.5])
    nothing = Scan(nodes, np.full(5, np.nan), none)
    assert not nothing.known
    assert nothing.failed(9.0).size == 5
    # A quarter of the interval is no end of it.
    wide = Scan(nodes, np.array([np.nan, 1.0, 1.0, 1.0, 1.0]), none)
    np.testing.assert_array_equal(wide.failed(9.0), [0.0])
