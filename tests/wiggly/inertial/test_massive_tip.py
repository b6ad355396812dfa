import jax
import jax.numpy as jnp
import numpy as np

import frictionjax as fx
from frictionjax.wiggly.equation import TipField
from frictionjax.wiggly.inertial.massive_tip import MassiveTip, TipMotion


def tip_of(eps=0.2):
    profile, bristle = fx.profiles.Sine(0.3), fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
    parts = fx.supports.Spring(1.3), fx.loads.Sine(1.1, 3.0)
    field = TipField(fx.potential(profile, bristle), *parts, eps, 0.7, 3.0, 0.4)
    return MassiveTip(field, jnp.asarray(0.05))


AT = TipMotion(*(jnp.asarray(x) for x in (0.17, 1.9, 0.0, 0.0)))


def test_slopes_are_the_derivatives_of_the_rates():
    tip, t = tip_of(), jnp.asarray(0.3)
    by_motion = jax.jit(jax.jacfwd(lambda m: tip.rates(t, m)))(AT)
    by_time = jax.jit(jax.jacfwd(lambda s: tip.rates(s, AT)))(t)
    found = jax.jit(lambda: tip.coupling(t, AT))()
    for name, value in found._asdict().items():
        row, _, column = name.partition("_by_")
        whole = getattr(by_time if column == "time" else by_motion, row)
        expected = whole if column == "time" else getattr(whole, column)
        np.testing.assert_allclose(value, expected, rtol=1e-12, err_msg=name)
    listed = len(found)
    every = [*jax.tree_util.tree_leaves(by_motion), *jax.tree_util.tree_leaves(by_time)]
    assert np.count_nonzero(np.abs(every) > 1e-14) == listed


def test_energy_goes_where_rates_say():
    tip, t = tip_of(), jnp.asarray(0.3)
    rates = tip.rates(t, AT)
    _, gained = jax.jvp(tip.energy, (AT,), (rates,))
    np.testing.assert_allclose(gained, rates.work - rates.lost, rtol=1e-12)
