"""The friction law: R."""

import jax.numpy as jnp
import numpy as np

import frictionjax as fx
from frictionjax.model.friction_law import dissipation_potential


def test_R_is_positively_homogeneous():
    v = jnp.asarray([-2.0, -1.0, 0.0, 1.0, 3.0])
    found = dissipation_potential(0.3, -0.2, v)
    np.testing.assert_allclose(found, [0.4, 0.2, 0.0, 0.3, 0.9], rtol=1e-15)


def test_coefficients_say_which_effects_they_leave_out():
    rod = fx.bristles.AngularSpring(1.0, length=2**0.5, height=1.0, rest_angle=0.3)
    parts = fx.profiles.Sine(0.5), rod, fx.supports.Spring(1.0), fx.loads.Ramp(1.0), 1.0
    plain = fx.friction(fx.Scene(*parts))
    assert "if" not in repr(plain)
    said = {
        "if the rod kept its nap": fx.effects.NapFlip(bending_stiffness=0.1),
        "without noise": fx.effects.Noise(1e-3),
    }
    for words, effect in said.items():
        found = fx.friction(fx.Scene(*parts, effects=(effect,)))
        assert repr(found).endswith(f": {words})")
        assert f"(friction {words}: " in str(found.table())
        assert found.rho_minus == plain.rho_minus
