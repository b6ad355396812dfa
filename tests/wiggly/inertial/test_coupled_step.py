import jax
import jax.numpy as jnp
import numpy as np

import frictionjax as fx
from frictionjax.wiggly.equation import TipField
from frictionjax.wiggly.inertial.coupled_step import step_with_mass
from frictionjax.wiggly.inertial.massive_tip import MassiveTip, TipMotion
from frictionjax.wiggly.rosenbrock import RODAS5P


def tip_of(mass):
    profile, bristle = fx.profiles.Sine(0.3), fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
    parts = fx.supports.Spring(1.3), fx.loads.Sine(1.1, 3.0)
    field = TipField(fx.potential(profile, bristle), *parts, 0.2, 0.7)
    return MassiveTip(field, jnp.asarray(mass))


@jax.jit
def step(tip, t, size, motion):
    return step_with_mass(RODAS5P, tip, t, size, motion)


def through(tip, count, span=0.2):
    motion, size = TipMotion(*map(jnp.asarray, (0.1, 1.0, 0.0, 0.0))), span / count
    for i in range(count):
        motion = step(tip, i * size, size, motion).end
    return np.array(motion)


def test_all_parts_are_of_order_five():
    tip = tip_of(0.05)
    fine = through(tip, 64)
    off = [np.abs(through(tip, count) - fine) for count in (4, 8, 16)]
    orders = np.log2(np.divide(off[:-1], off[1:]))
    assert np.all(orders[-1] > 4.4), orders


def test_the_last_stage_is_the_error_of_order_four():
    tip, start = tip_of(0.05), TipMotion(*map(jnp.asarray, (0.1, 1.0, 0.0, 0.0)))
    sizes = 0.01, 0.005
    stages = [step(tip, 0.0, h, start).stages for h in sizes]
    for name in ("tip", "speed"):
        first, second = (abs(float(getattr(s, name)[-1])) for s in stages)
        assert 4.4 < np.log2(first / second) < 5.6, name


def test_a_step_far_longer_than_speeds_last_forgets_them():
    tip, start = tip_of(1e-12), TipMotion(*map(jnp.asarray, (0.1, 50.0, 0.0, 0.0)))
    end = step(tip, 0.0, 1e-3, start).end
    force, _ = tip.field.driving_force(1e-3, end.tip)
    slow = float(force) / (0.7 * 0.2)
    np.testing.assert_allclose(end.speed, slow, rtol=1e-4)
