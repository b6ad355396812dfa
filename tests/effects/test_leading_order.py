"""`LeadingOrder`: the scene of eps W, beside the whole one."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

TWO_WAVES = fx.profiles.Fourier(cos=[0.0, 0.04 / (2 * np.pi)], sin=[0.1 / (2 * np.pi), 0.0])
VERTICAL = fx.bristles.VerticalSpring(1.0, 1.5, 1.0)  # k = 1, alpha = 0.5
RODS = {
    "vertical": VERTICAL,
    "slanted": fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5),
    "angular": fx.bristles.AngularSpring(1.0, 1.3, 1.0, 0.2),
}


LEADING = (fx.effects.LeadingOrder(),)


def scene_of(bristle, profile=TWO_WAVES, effects=LEADING, **more):
    parts = fx.supports.Spring(1.0), fx.loads.Sine(1.0488, 3.0), 3.0
    return fx.Scene(profile, bristle, *parts, effects=effects, **more)


def friction_at(potential, eps):
    """The largest V_eps' in N, over a period."""

    def best(places):
        forces = np.asarray(potential.force(eps * places, eps))
        return float(places[np.argmax(forces)]), float(np.max(forces))

    near, _ = best(np.linspace(0.0, 1.0, 2001))
    return best(near + np.linspace(-1e-3, 1e-3, 2001))[1]


def test_the_first_change_of_friction_is_that_of_the_rest():
    potential = fx.potential(TWO_WAVES, VERTICAL)
    rho = float(fx.friction(TWO_WAVES, VERTICAL).rho_plus)
    change = [(friction_at(potential, eps) - rho) / eps for eps in (1e-3, 5e-4)]
    # Extrapolated: what is left of order eps goes.
    assert 2 * change[1] - change[0] == pytest.approx(-1.06498e-3, abs=3e-8)


def test_a_sine_is_steepest_at_mean_height_and_changes_nothing_at_first_order():
    potential = fx.potential(fx.profiles.Sine(0.1), VERTICAL)
    rho = float(fx.friction(fx.profiles.Sine(0.1), VERTICAL).rho_plus)
    assert abs(friction_at(potential, 1e-3) - rho) < 1e-3 * 1e-6


@pytest.mark.parametrize("bristle", RODS.values(), ids=RODS)
def test_coefficients_and_limit_stay_the_same(bristle):
    plain, leading = scene_of(bristle, effects=()), scene_of(bristle)
    for name in ("rho_plus", "rho_minus", "alpha", "a"):
        pair = [float(getattr(fx.friction(s), name)) for s in (plain, leading)]
        assert pair[0] == pytest.approx(pair[1], rel=1e-14)
    ts = np.linspace(0, 3, 31)
    pair = [fx.solve_limit(s, ts).z for s in (plain, leading)]
    np.testing.assert_allclose(*pair, atol=1e-14)


@pytest.mark.parametrize("bristle", RODS.values(), ids=RODS)
def test_the_potential_is_its_leading_part_at_every_eps(bristle):
    from frictionjax.model import scene_for

    scene = scene_for(fx.effects.Engine.SWEEP, scene_of(bristle))
    Y, eps = np.linspace(-0.6, 0.7, 27), 0.05
    whole = fx.potential(TWO_WAVES, bristle)
    leading = eps * (whole.W(Y) - whole.W(0.0))
    found = scene.potential.energy(eps * Y, eps) - scene.potential.energy(0.0, eps)
    np.testing.assert_allclose(found, leading, atol=1e-15)
    assert float(jnp.max(jnp.abs(scene.potential.Q(eps, Y)))) < 1e-12


def test_trajectories_are_those_of_a_homothetic_bristle_where_tips_move_with_the_root():
    ts, eps = np.linspace(0, 3, 16), 1e-2
    leading = fx.solve(scene_of(VERTICAL), eps, ts=ts)
    homothetic = fx.solve(scene_of(fx.bristles.Homothetic(0.5), effects=()), eps, ts=ts)
    whole = fx.solve(scene_of(VERTICAL, effects=()), eps, ts=ts)
    assert leading.ok
    np.testing.assert_allclose(leading.z, homothetic.z, atol=1e-4 * eps)
    assert float(jnp.max(jnp.abs(leading.z - whole.z))) > 1e-4 * eps


def test_a_given_potential_loses_its_rest():
    rest = fx.GivenPotential(
        W=lambda Y: 0.02 * jnp.sin(2 * jnp.pi * Y),
        Q=lambda eps, Y: 0.3 * jnp.cos(2 * jnp.pi * Y),
    )
    parts = {"support": fx.supports.Spring(1.0), "load": fx.loads.Ramp(1.0, 0.0)}
    scene = fx.Scene(
        potential=rest, duration=1.0, effects=(fx.effects.LeadingOrder(),), **parts
    )
    alone = fx.Scene(potential=fx.GivenPotential(W=rest.W_fn), duration=1.0, **parts)
    pair = [fx.solve(s, 0.02, ts=[0.5, 1.0]).z for s in (scene, alone)]
    np.testing.assert_allclose(*pair, atol=1e-9)


@pytest.mark.slow  # a trajectory's program for these parts
def test_derivatives_go_through():
    def end(alpha):
        scene = scene_of(fx.bristles.Homothetic(alpha), profile=fx.profiles.Sine(0.1))
        return fx.solve(scene, 0.05, ts=[0.4], dissipation=False).z[0]

    slope = float(jax.grad(end)(0.5))
    assert slope == pytest.approx(
        float(end(jnp.asarray(0.5 + 1e-5)) - end(jnp.asarray(0.5 - 1e-5))) / 2e-5, rel=2e-2
    )
