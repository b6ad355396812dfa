"""The same scene in units of 12 orders of magnitude gives the same numbers."""

import numpy as np
import pytest
from catalogue import HARD
from few_wells import UNITS

import frictionjax as fx


@pytest.mark.parametrize("name", UNITS)
def test_numbers_do_not_know_their_units(name):
    base, one = HARD["kinks and plateaus"], HARD[name]
    length = one.eps / base.eps
    force = UNITS[name].force
    first = fx.solve(base.build(), base.eps, base.gamma, base.ts)
    other = fx.solve(one.build(), one.eps, one.gamma, one.ts)
    assert first.ok
    assert other.ok
    gap = np.abs(np.asarray(other.z) / length - np.asarray(first.z)) / base.eps
    # Steps are counted from the cell's first one: 6e-14 and less.
    assert gap.max() < 1e-9
    energies = np.asarray(other.dissipation) / (length * force)
    np.testing.assert_allclose(energies, first.dissipation, rtol=1e-9, atol=1e-12)


def test_they_span_twelve_orders_of_magnitude():
    stiffness = [one.force / one.length for one in UNITS.values()]
    assert max(stiffness) / min(stiffness) >= 0.999e12
