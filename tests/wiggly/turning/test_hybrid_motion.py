"""Rods that turn over at finite eps: against an independent code, and to the limit."""

import numpy as np
import pytest
from turning_by_scipy import EPS, GAMMA, Independent
from turning_by_scipy import scipy_scene as scene

import frictionjax as fx


def test_an_independent_code_says_the_same():
    told = np.array(Independent().run(5.0))
    # Away from slips and turnings, where an error in time is one in place.
    ts = np.linspace(0, 5, 501)
    found = fx.solve(scene(), EPS, GAMMA, ts, accuracy=1e-5)
    assert found.ok
    modes = [
        m for i, m in enumerate(found.mode.tolist()) if i == 0 or m != found.mode[i - 1]
    ]
    assert modes[:5] == [1, 0, -1, 0, 1]
    times, index = np.unique(told[:, 0], return_index=True)
    root = np.interp(ts, times, told[index, 1])
    off = np.abs(root - np.asarray(found.root))
    assert np.quantile(off, 0.9) < 2e-3 * EPS
    assert np.max(off) < 0.1 * EPS
    turned = told[np.flatnonzero(np.diff(told[:, 2])), 0]
    ours = ts[np.flatnonzero(np.diff(found.mode))]
    np.testing.assert_allclose(ours, turned[: ours.size], atol=0.011)


def test_energies_are_balanced():
    found = fx.solve(scene(), EPS, GAMMA, accuracy=1e-4)
    assert found.stats["dissipation_gap"] < 1e-3 * float(found.dissipation[-1])
    assert float(found.residual[-1]) < 1e-3 * float(found.dissipation[-1])
    loose = fx.solve(scene(), EPS, GAMMA, accuracy=1e-2)
    tight = fx.solve(scene(), EPS, GAMMA, accuracy=1e-6)
    spent = [float(one.dissipation[-1]) for one in (found, tight, loose)]
    assert abs(spent[0] - spent[1]) < 1e-4 * spent[1]
    assert abs(spent[2] - spent[1]) < 1e-2 * spent[1]


def test_it_comes_to_the_limit():
    """In proportion to eps where the support is stiff enough that nothing jumps."""
    one = scene(load=fx.loads.Triangle(2.5, 4.0), bending=0.1, duration=4.0)
    ts = np.linspace(0, 4, 201)
    limit = fx.solve_limit(one, ts)
    off = []
    for eps in (0.03, 0.01, 0.003):
        found = fx.solve(one, eps, 1.0, ts)
        assert found.ok
        off.append(float(np.max(np.abs(found.z - limit.z))))
    assert off[0] > 2 * off[1] > 4 * off[2]
    assert off[2] < 0.1


@pytest.mark.slow
@pytest.mark.parametrize("bending", [0.1, 0.19])
def test_loops_are_within_two_percent_at_one_thousandth(bending):
    one = scene(load=fx.loads.Triangle(2.5, 4.0), bending=bending, duration=8.0)
    ts = np.linspace(0, 8, 201)
    limit, found = fx.solve_limit(one, ts), fx.solve(one, 1e-3, 1.0, ts)
    assert found.ok
    width = float(np.ptp(limit.z))
    assert np.max(np.abs(found.z - limit.z)) < 0.02 * width
    lost = [float(s.dissipation[-1]) for s in (found, limit)]
    assert lost[0] == pytest.approx(lost[1], rel=0.02)


def test_a_budget_ends_it():
    found = fx.solve(scene(), EPS, GAMMA, [1.0, 5.0], max_steps=500)
    assert found.status is fx.Status.MAX_STEPS
    assert np.isnan(found.z[-1])


def test_derivatives_are_refused():
    import jax

    with pytest.raises(ValueError, match="no derivatives"):
        jax.grad(lambda eps: fx.solve(scene(), eps, GAMMA, [1.0]).z[0])(EPS)
