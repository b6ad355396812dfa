"""The scheme has the order that it is said to have, and its matrices are inverted."""

import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.numerics import RADAU_PLACES, RADAU_WEIGHTS, inverse_of_three


@pytest.mark.parametrize("power", range(5))
def test_last_row_integrates_powers(power):
    last = RADAU_WEIGHTS[-1] @ RADAU_PLACES**power
    assert last == pytest.approx(1 / (power + 1), rel=1e-14)


@pytest.mark.parametrize("power", range(3))
def test_stages_integrate_powers(power):
    """Stage order 3, and the last stage is the end."""
    stages = RADAU_WEIGHTS @ RADAU_PLACES**power
    np.testing.assert_allclose(
        stages, RADAU_PLACES ** (power + 1) / (power + 1), rtol=1e-14
    )
    assert RADAU_PLACES[-1] == 1


def test_inverses():
    matrix = np.random.default_rng(3).normal(size=(3, 3)) + 3 * np.eye(3)
    found = inverse_of_three(jnp.asarray(matrix))
    np.testing.assert_allclose(found, np.linalg.inv(matrix), rtol=1e-13)
