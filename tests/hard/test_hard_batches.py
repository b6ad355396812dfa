"""The same answer alone, in a batch, and shuffled in a batch beside a failing lane."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from asked import named
from catalogue import HARD

import frictionjax as fx
from frictionjax.wiggly.batch import integrate_cells
from frictionjax.wiggly.equation.status import FailedCells

ACCURACY = 1e-3
SAME = 1e-3 * ACCURACY
SLOW = [name for name in HARD if name not in ("far above", "1e6 slips")]


def cells(one, scene, eps, gamma):
    """Cells as a sweep solves them, in this order."""
    found = integrate_cells(
        scene, np.array(eps), np.array(gamma), one.ts, ACCURACY, "auto", True
    )
    assert found is not None
    return found


@pytest.mark.parametrize("name", named(slow=SLOW))
def test_alone_in_a_batch_and_beside_a_failing_lane(name):
    one = HARD[name]
    scene = one.build()
    alone = cells(one, scene, [one.eps], [one.gamma])
    near = 0.83 * one.eps, 1.1 * one.gamma
    # eps^(1 + gamma) under- or overflows: that cell fails.
    batch = cells(one, scene, [one.eps, near[0]], [one.gamma, near[1]])
    tired = [near[0], one.eps, one.eps, near[0]], [near[1], 400.0, one.gamma, one.gamma]
    beside = cells(one, scene, *tired)
    assert beside.status[1] != 0
    assert alone.status[0] == batch.status[0] == beside.status[2] == 0
    for found, lane in ((batch, 0), (beside, 2)):
        assert np.abs(found.z[lane] - alone.z[0]).max() <= SAME * one.eps
        most = alone.dissipation[0, -1]
        assert np.abs(found.dissipation[lane] - alone.dissipation[0]).max() <= SAME * most
    same = cells(one, scene, [one.eps], [one.gamma])
    assert np.array_equal(same.z, alone.z)


def test_a_viscosity_that_no_float_holds_is_a_status():
    """In wells of 10 m; NumPy warned of an overflow, which here is an error."""
    bristle, load = fx.bristles.Homothetic(1e4), fx.loads.Sine(3000.0, 3.0)
    scene = fx.Scene(fx.profiles.Sine(0.1), bristle, fx.supports.Spring(1.0), load, 3.0)
    with pytest.warns(FailedCells, match="1 of 2 cells failed"):
        found = fx.sweep(scene, [10.0], [400.0, 1.0])
    assert np.isinf(found.viscosity.sel(gamma=400.0)).all()
    assert int(found.status.sel(gamma=400.0).item()) != 0
    assert int(found.status.sel(gamma=1.0).item()) == 0


def test_a_failing_lane_disturbs_no_other_cell_of_a_sweep():
    scene, ts = HARD["kinks and plateaus"].build(), np.linspace(0.0, 3.0, 61)
    alone = fx.sweep(scene, [0.05, 0.02], [1.0], ts)
    with pytest.warns(FailedCells):
        beside = fx.sweep(scene, [0.05, 0.02, 1e-8], [1.0, 39.0], ts)
    bad = beside.sel(gamma=39.0, eps=1e-8)
    assert int(bad.status) != 0
    assert np.isnan(float(bad.sup_error))
    for eps in (0.05, 0.02):
        gap = np.abs(beside.z.sel(gamma=1.0, eps=eps) - alone.z.sel(gamma=1.0, eps=eps))
        assert float(gap.max()) <= 1e-6 * eps


@pytest.mark.slow
@pytest.mark.parametrize("name", ["two folds", "alpha < 0", "far above", "on a summit"])
def test_under_vmap_beside_a_failing_lane(name):
    """What is traced goes another way, through diffrax: the same there."""
    one = HARD[name]
    scene = one.build()
    parts, static = eqx.partition(scene, eqx.is_array)
    ts = one.ts[::6]

    @jax.jit
    def states(eps, gamma, numbers):
        return fx.solve(eqx.combine(numbers, static), eps, gamma, ts).z

    alone = states(one.eps, one.gamma, parts)
    eps = jnp.array([0.9 * one.eps, 1e-8, one.eps])
    gamma = jnp.array([1.1 * one.gamma, 39.0, one.gamma])
    batch = jax.vmap(states, in_axes=(0, 0, None))(eps, gamma, parts)
    assert np.all(np.isnan(batch[1, 1:]))
    assert np.abs(batch[2] - alone).max() <= SAME * one.eps
