"""The curve of every hard scene whose slips floats can sample is certified."""

import numpy as np
import pytest
from asked import named
from catalogue import HARD

import frictionjax as fx

_COUNT = 16001  # of all curves: a kind of scene compiles once
_FINE = 0.08  # of eps between two samples, of wells as wide as a sine's
_FINER = {"rod upright": 0.02}
# Slips of 1e-15 s and less at times near 1 s: no two floats in one.
_TOO_SHORT = ("eps 1e-8", "slips shorter than floats")
_WINDOW = 12  # slip periods of a long slide
_QUICK = ("kinks and plateaus",)


def window_of(one) -> tuple[float, float]:
    """All of a scene of some tens of wells; some periods of a longer one."""
    period = one.eps * one.system.stiffness / one.system.rate
    if one.system.duration < 400 * period:
        return 0.0, one.system.duration
    begin = 0.9 * one.system.kinks[0]
    return begin, begin + _WINDOW * period


def sampled(one, fine: float = _FINE) -> tuple[np.ndarray, np.ndarray]:
    """A curve with samples closer than `fine` eps, by halving where it moves faster."""
    scene, ts = one.build(), np.linspace(*window_of(one), 1001)
    for _ in range(40):
        full = np.append(ts, np.full(_COUNT - ts.size, ts[-1]))
        found = fx.solve(scene, one.eps, one.gamma, full, 1e-6, dissipation=False)
        assert found.ok, found.status.message
        z = np.asarray(found.z)[: ts.size]
        fast = np.flatnonzero(np.abs(np.diff(z)) > fine * one.eps)
        if not fast.size:
            return ts, z
        parts = np.clip((_COUNT - ts.size) // fast.size, 1, 7)
        inside = np.arange(1, parts + 1) / (parts + 1)
        new = ts[fast][:, None] + inside * (ts[fast + 1] - ts[fast])[:, None]
        ts = np.unique(np.append(ts, new))
    raise AssertionError("slips are not resolved")


@pytest.mark.parametrize(
    "name",
    named(
        [name for name in HARD if name not in _TOO_SHORT],
        slow=[name for name in HARD if name not in _QUICK],
    ),
)
def test_the_curve_is_certified(name):
    one = HARD[name]
    ts, z = sampled(one, _FINER.get(name, _FINE))
    found = fx.certify(one.build(), one.eps, one.gamma, ts, z)
    assert found.ok, found
    assert found.distance < 0.03
    assert found.skipped == 0


@pytest.mark.parametrize(
    "name",
    ["kinks and plateaus", pytest.param("1e6 slips", marks=pytest.mark.slow)],
)
def test_a_curve_that_skips_a_well_is_not(name):
    one = HARD[name]
    ts, z = sampled(one)
    wrong = z + np.where(ts > ts[z.size // 2], one.eps, 0.0)
    spoiled = fx.certify(one.build(), one.eps, one.gamma, ts, wrong)
    assert not spoiled.ok


@pytest.mark.slow
def test_slips_that_floats_cannot_sample_are_said_to_be():
    one = HARD["slips shorter than floats"]
    begin, end = window_of(one)
    ts = np.linspace(begin, end, 2001)
    z = fx.solve(one.build(), one.eps, one.gamma, ts).z
    found = fx.certify(one.build(), one.eps, one.gamma, ts, z)
    assert not found.ok
    assert "undecided" in found.message
