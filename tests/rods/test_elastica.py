"""The elastica between hinged ends: figures, energy, and an equation solved apart."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from frictionjax.rods import bent_between_hinges, hinged_load

B, L = 2.0, 3.0
CRITICAL = np.pi**2 * B / L**2
CHORDS = [0.99, 0.95, 0.9, 0.8, 0.5**0.5]
THRUSTS = [1.00502829, 1.02572426, 1.05298688, 1.11273872, 1.17556103]


@jax.jit
def thrust(chord):
    return bent_between_hinges(B, L, chord).thrust


@jax.jit
def energy(chord):
    return bent_between_hinges(B, L, chord).energy


@jax.jit
def slopes_and_thrusts(chords):
    return jax.vmap(jax.grad(energy))(chords), thrust(chords)


def test_the_thrust_is_that_of_known_figures():
    found = np.asarray(thrust(L * np.array(CHORDS))) / CRITICAL
    np.testing.assert_allclose(found, THRUSTS, atol=5e-9)


@pytest.mark.parametrize(
    ("share", "angles"), [(0.9, (0.3, 2.0)), (0.0, (1.5, 2.8)), (-0.5, (2.6, 3.1))]
)
def test_a_rod_pushed_so_hard_has_that_chord_and_energy(share, angles):
    """`B theta'' = -P sin theta` from one hinge to the other, by another integrator."""
    load = float(thrust(jnp.asarray(share * L)))

    def rod(turned):
        def slopes(_, state):
            angle, bend = state[:2]
            return bend, -load / B * np.sin(angle), np.cos(angle), 0.5 * B * bend**2

        return solve_ivp(slopes, (0, L), (turned, 0, 0, 0), rtol=1e-12, atol=1e-12).y[:, -1]

    at_first = brentq(lambda turned: rod(turned)[1], *angles, xtol=1e-13)
    _, _, chord, stored = rod(at_first)
    assert chord == pytest.approx(share * L, abs=1e-8 * L)
    assert stored == pytest.approx(float(energy(jnp.asarray(share * L))), rel=1e-8)


def test_the_energy_falls_by_the_thrust_from_the_straight_rod_on():
    chords = L * np.array([1.0, 1 - 1e-9, 0.7, 0.0, -0.3, -0.79])
    slopes, thrusts = slopes_and_thrusts(chords)
    np.testing.assert_allclose(slopes, -thrusts)
    assert float(bent_between_hinges(B, L, jnp.asarray(L)).energy) == 0
    assert float(thrust(jnp.asarray(L))) == pytest.approx(CRITICAL, rel=1e-15)
    near = float(energy(jnp.asarray(L * (1 - 1e-10))))
    assert near == pytest.approx(CRITICAL * L * 1e-10, rel=1e-6)
    # P = P_cr (1 + s/2 + 9 s^2/32 + ...) at a shortening of s lengths.
    bend = jax.jit(jax.grad(jax.grad(thrust)))(jnp.asarray(L))
    assert float(bend) == pytest.approx(CRITICAL / L**2 * 9 / 16, rel=1e-13)


def test_chords_that_the_rod_cannot_have_are_nan():
    chords = L * np.array([1.01, -0.9, np.nan])
    found = jax.jit(bent_between_hinges)(B, L, chords)
    assert np.all(np.isnan(found))


def test_it_is_traced_in_every_number():
    def stored(numbers):
        return bent_between_hinges(*numbers).energy

    numbers = jnp.asarray([B, L, 0.6 * L])
    energy_then, slopes = jax.jit(jax.value_and_grad(stored))(numbers)
    by_B, by_L, by_chord = map(float, slopes)
    assert by_B == pytest.approx(float(energy_then) / B)
    # U = B/L f(chord/L), so B U_B = - L U_L - chord U_chord.
    assert B * by_B == pytest.approx(-L * by_L - 0.6 * L * by_chord)
    assert float(hinged_load(B, L)) == pytest.approx(CRITICAL, rel=1e-15)
