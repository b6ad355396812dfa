"""Critical loads: figures, limits, and the beam's equation by finite differences."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.rods import hinged_load, sprung_load

FIGURES = [
    (1e-300, 9.869604),
    (1.0, 11.598166),
    (10.0, 17.076295),
    (100.0, 19.796998),
    (1e300, 20.190729),
]


@pytest.mark.parametrize(("clamping", "square"), FIGURES)
def test_the_load_on_an_angular_spring_is_that_of_known_figures(clamping, square):
    assert float(sprung_load(1.0, 1.0, clamping)) == pytest.approx(square, abs=5e-7)


@pytest.mark.parametrize("clamping", [0.0, 1e-3, 0.3, 1.0, 7.0, 1e4])
def test_it_solves_its_equation(clamping):
    B, L = 2.0, 3.0
    load = float(sprung_load(B, L, clamping * B / L))
    u = np.sqrt(load * L**2 / B)
    if clamping == 0:
        assert load == pytest.approx(float(hinged_load(B, L)), rel=1e-14)
    else:
        assert np.tan(u) * (1 + u**2 / clamping) == pytest.approx(u, rel=1e-9)


def test_it_is_the_least_load_of_a_beam_in_pieces():
    """`B v'''' + P v'' = 0`, `v = 0` at both ends, `B v'' = k v'` at the root."""
    B, L, k, n = 2.0, 3.0, 1.5, 400
    h = L / n
    # Energy of bending and of the spring against that of shortening, v linear in pieces.
    turns = (np.eye(n, n + 1, 1) - np.eye(n, n + 1))[:, 1:-1] / h
    bends = np.diff(turns, axis=0) / np.sqrt(h)
    stored = B * bends.T @ bends + k * np.outer(turns[0], turns[0])
    shortened = h * turns.T @ turns
    loads = np.linalg.eigvals(np.linalg.solve(shortened, stored))
    assert float(sprung_load(B, L, k)) == pytest.approx(loads.real.min(), rel=4e-3)


def test_derivatives_go_through_it():
    def load(k):
        return sprung_load(2.0, 3.0, k)

    k, step = 1.5, 1e-4
    by_hand = (load(k + step) - load(k - step)) / (2 * step)
    assert float(jax.grad(load)(jnp.asarray(k))) == pytest.approx(float(by_hand), rel=1e-7)
