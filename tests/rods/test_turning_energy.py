"""Energy of a rod that turns over its pinned tip."""

import jax
import numpy as np
import pytest

from frictionjax.rods import TurningRod, hinged_load

ROD = TurningRod(2.0, 0.3, 1.4, 0.15, 0.9)
REACH = (1.4**2 - 0.9**2) ** 0.5
LIMIT = np.arccos(0.9 / 1.4)


def test_at_both_ends_it_is_the_straight_rod():
    assert float(ROD.reach) == pytest.approx(REACH, rel=1e-15)
    for side in (1, -1):
        straight = 0.5 * 2.0 * (side * LIMIT - 0.3) ** 2
        assert float(ROD.energy(side * ROD.reach)) == pytest.approx(straight, rel=1e-12)


def test_force_is_the_derivative_of_energy():
    slope, force = jax.jit(jax.grad(ROD.energy)), jax.jit(ROD.force)
    for ahead in np.linspace(-0.97, 0.97, 9) * REACH:
        expected = float(slope(ahead))
        assert float(force(ahead)) == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_it_begins_with_the_force_of_a_straight_rod_at_the_critical_load():
    """Pinned and straight: `N (cos, sin)` with what the spring adds across the rod."""
    critical = float(hinged_load(0.15, 1.4))
    across = 2.0 * (LIMIT - 0.3) / 1.4
    force = across * np.cos(LIMIT) - critical * np.sin(LIMIT)
    assert float(ROD.force(ROD.reach)) == pytest.approx(force, rel=1e-9)
    across = 2.0 * (-LIMIT - 0.3) / 1.4
    force = across * np.cos(LIMIT) + critical * np.sin(LIMIT)
    assert float(ROD.force(-ROD.reach)) == pytest.approx(force, rel=1e-9)


def test_what_its_tip_presses_with_is_the_derivative_by_its_height():
    """Of a root that is let down: energy rises by what the surface holds."""
    slope = jax.jit(jax.grad(lambda h, x: ROD._replace(height=h).energy(x)))
    weight = jax.jit(ROD.weight)
    for ahead in np.linspace(-0.9, 0.9, 7) * REACH:
        expected = -float(slope(0.9, ahead))
        assert float(weight(ahead)) == pytest.approx(expected, rel=1e-9)
