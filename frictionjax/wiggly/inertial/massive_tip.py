"""Vector field of a tip with mass, in the tip coordinate."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp

from ..._checks import Real
from ..equation import TipField


class TipMotion(NamedTuple):
    """What moves: `tip` y in periods from its well, `speed` z'/eps in 1/s.

    `lost`: `int eps^gamma z'^2`, `work`: `int l z'`, both in J since the start. They are
    integrated with the rest, so that what is left of the energy balance is a check.
    """

    tip: Real
    speed: Real
    lost: Real
    work: Real


class FieldSlopes(NamedTuple):
    """Derivatives of the field at one point, by name of the row and the column.

    Columns `lost` and `work` are zero, and so is what is not listed.
    """

    tip_by_tip: Real
    tip_by_speed: Real
    speed_by_tip: Real
    speed_by_speed: Real
    lost_by_speed: Real
    work_by_speed: Real
    speed_by_time: Real
    work_by_time: Real


class MassiveTip(eqx.Module):
    """`m z'' + eps^gamma z' = l(t) - Phi'(z) - V_eps'(z)` as a system of first order.

    With `z = eps (well + y) + A` and `G = dz/dp` it needs no derivative of G:
    `y' = speed/G`, `speed' = (l - Phi' - V_eps' - eps^gamma z')/(m eps)`. `mass` in kg.
    """

    field: TipField
    mass: Real

    def rates(self, t: Real, motion: TipMotion) -> TipMotion:
        """Time derivatives of all four."""
        field = self.field
        force, stretch, _, load = field.driven(t, motion.tip)
        velocity = field.eps * motion.speed
        drag = field.viscosity * velocity
        return TipMotion(
            tip=motion.speed / stretch,
            speed=(force - drag) / (self.mass * field.eps),
            lost=drag * velocity,
            work=load * velocity,
        )

    def coupling(self, t: Real, motion: TipMotion) -> FieldSlopes:
        """The derivatives of `rates`."""
        field, one = self.field, jnp.ones_like(motion.tip)
        driven, slopes = jax.jvp(lambda y: field.driven(t, y), (motion.tip,), (one,))
        velocity = field.eps * motion.speed
        return FieldSlopes(
            tip_by_tip=-motion.speed * slopes.stretch / driven.stretch**2,
            tip_by_speed=1 / driven.stretch,
            speed_by_tip=slopes.force / (self.mass * field.eps),
            speed_by_speed=-field.viscosity / self.mass,
            lost_by_speed=2 * field.viscosity * velocity * field.eps,
            work_by_speed=driven.load * field.eps,
            speed_by_time=field.load_slope(t) / (self.mass * field.eps),
            work_by_time=field.load_slope(t) * velocity,
        )

    def energy(self, motion: TipMotion) -> Real:
        """`Phi + V_eps + m z'^2/2` in J, without the load."""
        field = self.field
        still = field.support.energy(field.state(motion.tip))
        still = still + field.potential.tip_energy_change(motion.tip, field.eps)
        return still + 0.5 * self.mass * (field.eps * motion.speed) ** 2
