import jax.numpy as jnp
import numpy as np
import pytest
from noisy_wells import COSINE, SLANTED

import frictionjax as fx
from frictionjax.stochastic.force_table import tabulated_force

# Far from nodes and in many wells.
STATES = np.random.default_rng(3).uniform(-20.0, 20.0, 2000)


@pytest.mark.parametrize("eps", [0.3, 1e-4])
def test_the_table_is_the_force_of_the_potential(eps):
    """Found in z through the tip of a slanted bristle, at its true height."""
    found = tabulated_force(SLANTED, eps)
    exact = np.asarray(SLANTED.force(eps * STATES, eps))
    seen = np.asarray(found.table.force(eps * STATES, jnp.asarray(eps)))
    assert np.max(np.abs(seen - exact)) <= 1.1 * found.error + 1e-11
    assert found.error < 1e-7
    assert found.highest == pytest.approx(exact.max(), abs=1e-4)
    assert found.lowest == pytest.approx(exact.min(), abs=1e-4)


def test_curvature_is_the_steepest_rise_of_the_force():
    assert tabulated_force(COSINE, 0.1).curvature == pytest.approx(2 * np.pi, rel=1e-5)
    leaning = tabulated_force(SLANTED, 0.1)
    grid = np.linspace(0, 0.1, 20001)
    slopes = np.diff(np.asarray(SLANTED.force(grid, 0.1))) / np.diff(grid)
    assert leaning.curvature == pytest.approx(slopes.max(), rel=1e-3)


@pytest.mark.slow
def test_a_surface_with_bends_gets_more_cells_and_its_error_is_told():
    rough = fx.profiles.Spline(np.array([0.0, 0.03, 0.01, 0.06, 0.02, -0.01]))
    potential = fx.potential(rough, fx.bristles.VerticalSpring(1.0, 2.0, 1.0))
    found = tabulated_force(potential, 0.05)
    cells = found.table.cubics.shape[1]
    assert cells > 1024
    bends = (np.arange(1, 6) / 6)[:, None] + np.linspace(-1, 1, 41) / cells
    places = np.concatenate([bends.ravel(), STATES])
    exact = np.asarray(potential.force(0.05 * places, 0.05))
    seen = np.asarray(found.table.force(0.05 * places, jnp.asarray(0.05)))
    worst = np.max(np.abs(seen - exact))
    assert worst <= 1e-6
    assert 0.3 * worst < found.error < 3 * worst
