"""The equations of two feet, and the order of their steps."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.crawling.settings import SETTINGS
from frictionjax.crawling.two_feet import TwoFeet, step_of_feet

ROD = fx.bristles.AngularSpring(1.0, length=1.414, height=1.0, rest_angle=0.3)


def feet(stiffness=1.4):
    potential = fx.potential(fx.profiles.Fourier([0.0, 0.004], [0.015, 0.0]), ROD)
    load = fx.loads.Sine(0.7, 1.0)  # 1.4 N/m times a length
    numbers = (jnp.asarray(v) for v in (stiffness, 0.05, 0.04))
    return TwoFeet(potential, load, *numbers, jnp.asarray([0.0, 3.0]), jnp.asarray(0.2))


def test_energies_change_by_what_is_given_and_lost():
    """dE/dt = work' - lost', of any motion that the rates make; E without the load."""
    of = feet()

    @jax.jit
    def changes(t, motion):
        rates = of.rates(t, motion)
        return rates, jax.jvp(of.energy, (motion,), (rates,))[1]

    for seed in range(5):
        rng = np.random.default_rng(seed)
        motion = jnp.asarray([*rng.uniform(-0.5, 0.5, 2), 0.0, 0.0])
        t = jnp.asarray(rng.uniform(0, 1))
        rates, change = changes(t, motion)
        assert float(rates[2]) > 0
        assert float(change) == pytest.approx(float(rates[3] - rates[2]), rel=1e-10)


def test_a_foot_alone_is_the_wiggly_system():
    """The front foot far away and held by nothing: the rear one is pulled by a spring."""
    of = feet()
    motion = jnp.asarray([0.1, -0.2, 0.0, 0.0])
    known = eqx.filter_jit(of.feet)(motion)
    t, places = jnp.asarray(0.1), known.place
    force = 1.4 * (places[1] - places[0]) - float(of.load(0.3))
    pulls = of.potential.force(places, 0.05)
    expected = (np.array([force, -force]) - pulls) / (0.04 * 0.05 * known.stretch)
    np.testing.assert_allclose(eqx.filter_jit(of.rates)(t, motion)[:2], expected, rtol=1e-9)


def test_steps_are_of_their_order():
    """One step against many small ones: off by h^6. The spring is stiffer than wells."""
    of, start = feet(10.0), jnp.asarray([0.1, -0.2, 0.0, 0.0])

    @jax.jit
    def ends(size, count):
        def step(i, motion):
            t = size * i / count
            size_of_one = size / count
            return step_of_feet(SETTINGS.tableau, of.rates, t, size_of_one, motion).end

        return jax.lax.fori_loop(0, count, step, start)

    far, near = (np.max(np.abs(ends(s, 1) - ends(s, 64))[:2]) for s in (2.5e-4, 3.125e-5))
    order = np.log(far / near) / np.log(8)
    assert 5.5 < order < 8.0
