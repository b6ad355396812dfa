"""Equilibria over a pinned tip: followed, and lost in jumps."""

import numpy as np
import pytest
from numpy.polynomial import Chebyshev

from frictionjax.turning.way_over import WayOver

BALANCE = Chebyshev([0.1, 0.4, 0.3, -0.5, 0.2, 0.6], domain=[-2.0, 2.0])  # turns four times


def crept(balance, ahead, before, load, way):
    """The same by small steps of a root that goes where it is pushed."""
    places = np.linspace(ahead, 2.0 * way, 400_001)
    lost, level = 0.0, before
    values = balance(places)
    steps = np.diff(places)
    for value, step, place in zip(values, steps, places, strict=False):
        if way * (value - load) > 0:
            return place, load, lost, 0
        level = max(level, value) if way > 0 else min(level, value)
        lost += (level - value) * step
    return 2.0 * way, level, lost, way


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("start", [0.02, 0.3, 0.5, 0.9])
@pytest.mark.parametrize("share", [0.05, 0.4, 1.0, 3.0])
def test_it_goes_where_small_steps_go(way, start, share):
    path = WayOver.of(BALANCE)
    ahead = -way * 2.0 + way * 4.0 * start
    before = float(BALANCE(ahead))
    load = before + way * share
    found = path.follow(ahead, before, load, way)
    where, level, lost, out = crept(BALANCE, ahead, before, load, way)
    assert found.out == out
    assert found.ahead == pytest.approx(where, abs=5e-5)
    assert found.load == pytest.approx(level, abs=1e-4)
    assert found.lost == pytest.approx(lost, abs=5e-5)


def test_one_way_and_back_loses_what_jumps_lose():
    path = WayOver.of(BALANCE)
    there = path.follow(-2.0, float(BALANCE(-2.0)), 5.0, 1)
    back = path.follow(2.0, float(BALANCE(2.0)), -5.0, -1)
    assert (there.out, back.out) == (1, -1)
    assert there.lost > 0
    assert back.lost > 0
    # Around the loop the work of the loads is what is lost.
    rising = float(np.max(BALANCE(np.linspace(-2, 2, 9))))
    assert there.load == pytest.approx(max(rising, there.load))


def test_where_nothing_turns_nothing_is_lost():
    path = WayOver.of(Chebyshev([0.0, 1.0, 0.1], domain=[-1.0, 1.0]))
    found = path.follow(-1.0, -0.9, 0.3, 1)
    assert found.lost == 0.0
    assert float(path.balance(found.ahead)) == pytest.approx(0.3, abs=1e-14)
