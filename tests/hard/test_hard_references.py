"""The references themselves: with more kept, and where two of them hold at once."""

from dataclasses import replace

import numpy as np
import pytest
from catalogue import HARD
from entry import every_slip, plain
from quasi_static import quasi_static
from shortened import cuts_of, shortened_with
from springs import SINE, Spring, entry_of


def gap(one, first, second) -> float:
    """Largest difference outside slips, eps, and of the dissipation."""
    outside = ~(first.in_slip | second.in_slip)
    assert outside.sum() >= 45
    lost = np.abs(first.dissipation - second.dissipation)[outside]
    assert lost.max() < 2e-4 * first.dissipation[-1]
    return float(np.abs(first.z - second.z)[outside].max() / one.eps)


@pytest.mark.parametrize("gamma", [1.0, pytest.param(2.0, marks=pytest.mark.slow)])
def test_cutting_periods_out_changes_nothing(gamma):
    load = (0.0, 3.5037, 3.5037, -3.4123, -3.4123, 0.4, 0.4)
    one = entry_of(Spring("", gamma=gamma, values=load, pace=4.0))
    assert sum(cut.count for cut in cuts_of(one, 25)) > 100
    whole = plain(one, one.ts)
    assert gap(one, whole, shortened_with(stay=25)(one, one.ts)) < 1e-6


@pytest.mark.parametrize("name", ["1e6 slips", "1e6 slips in 3 s"])
def test_more_periods_give_the_same(name):
    one = HARD[name]
    cuts = cuts_of(one)
    slid = sum(cut.count for cut in cuts if cut.sign)
    assert slid >= 1e6
    solve = {"solve": quasi_static(SINE, 1.0)} if one.eps < 1e-3 else {}
    first, second = (shortened_with(stay=n, **solve)(one, one.ts) for n in (40, 80))
    assert gap(one, first, second) < 2e-5
    assert np.abs(np.diff(first.z)).sum() > 1e6 * one.eps


@pytest.mark.slow
def test_slips_without_duration_at_gamma_4():
    one = entry_of(Spring("", 0.02, 4.0))
    swift = replace(one, truth=quasi_static(SINE, 1.0))
    assert gap(one, every_slip(one, one.ts), swift.truth(swift, one.ts)) < 2e-5
