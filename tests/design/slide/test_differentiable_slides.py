"""Derivatives of steady slides outside of compiled functions, as notebooks take them."""

import jax
import jax.numpy as jnp
import numpy as np
from designs import SLANTED

import frictionjax as fx

EPS = jnp.array([0.02, 0.05])


def forces(slope, eps=EPS):
    found = fx.steady_slide(fx.profiles.Sine(slope), SLANTED, eps)
    return jnp.stack([found.mean_plus, found.peak_minus])


def test_both_modes_have_the_derivatives_that_differences_say():
    """Each eps its own, whichever numbers are asked for, plain or arrays."""
    width = 1e-4
    known = (forces(0.1 + width) - forces(0.1 - width)) / (2 * width)
    forth = jax.jacfwd(forces)(0.1)
    np.testing.assert_allclose(forth, known, rtol=1e-5)  # steps are chosen anew
    back, by_eps = jax.jacrev(forces, (0, 1))(0.1, EPS)
    np.testing.assert_allclose(back, forth, rtol=1e-12)
    known = (forces(0.1, 1.001 * EPS) - forces(0.1, 0.999 * EPS)) / (0.002 * EPS[None, :])
    assert by_eps.shape == (2, 2, 2)
    np.testing.assert_allclose(by_eps[:, 0, 1], 0.0, atol=1e-12)
    np.testing.assert_allclose(jnp.diagonal(by_eps, 0, 1, 2), known, rtol=0, atol=5e-5)
