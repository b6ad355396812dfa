"""A scene as it is, and in the mirror in which a rod turned over stands as before.

`side` is 1 or -1. With it a state `z_side` means `z = side z_side - shift`, shift 0 or 2 c.
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from .._checks import Real
from ..bristles import AbstractBristle, AngularSpring
from ..loads import AbstractPull
from ..model import BristlePotential
from ..numerics import slope_of
from ..profiles import AbstractProfile
from ..supports import AbstractSupport


class SidedProfile(AbstractProfile):
    """`w(side y)`."""

    profile: AbstractProfile
    side: Real

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return self.profile(self.side * jnp.asarray(y))

    @property
    def points(self) -> int:
        return self.profile.points


class SidedSupport(AbstractSupport):
    """`Phi` of the state that `z_side` means."""

    support: AbstractSupport
    side: Real
    shift: Real

    def place(self, z: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        """The state in m that one of this side means."""
        return self.side * z - self.shift

    def energy(self, z: Real) -> Real:
        return self.support.energy(self.place(z))

    def state_of(self, force: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return self.side * (self.support.state_of(self.side * force) + self.shift)

    def force(self, z: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return self.side * self.support.force(self.place(z))

    def stiffness_at(self, z: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return self.support.stiffness_at(self.place(z))


class SidedLoad(AbstractPull):
    """`side l(t)`."""

    load: AbstractPull
    side: Real

    def __call__(self, t: Real) -> Real:
        return self.side * self.load(t)

    def slope(self, t: Real) -> Real:
        return self.side * self.load.slope(t)


def sided_potential(
    profile: AbstractProfile, rod: AngularSpring, side: Real
) -> BristlePotential:
    """The wiggly potential of a side: the rest angle is on the other one in a mirror."""
    turned: AbstractBristle = eqx.tree_at(
        lambda one: one.rest_angle, rod, side * rod.rest_angle
    )
    return BristlePotential(SidedProfile(profile, side), turned)


class SceneParts(eqx.Module):
    """What moves: all in tables but the rod. `reach` c in m, `critical` load in N."""

    profile: AbstractProfile
    rod: AngularSpring
    support: AbstractSupport
    load: AbstractPull
    reach: Real
    critical: Real

    def potential(self, side: Real) -> BristlePotential:
        """The wiggly potential of a side."""
        return sided_potential(self.profile, self.rod, side)

    def held(self, side: Real) -> SidedSupport:
        """The support of a side."""
        return SidedSupport(self.support, side, (1 - side) * self.reach)

    def pulled(self, side: Real) -> SidedLoad:
        """The load of a side."""
        return SidedLoad(self.load, side)


def compression(potential: BristlePotential, y: Real, eps: Real) -> Real:
    """Along the straight rod in N, its tip at y: `N (cos(theta) - w' sin(theta))`."""
    eta = eps * potential.profile(y)
    pull, stretch = potential.tip_force(y, eps)
    stance = potential.bristle.geometry(eta)
    assert stance is not None
    normal = slope_of(potential.bristle.energy)(eta) / stretch
    return normal * jnp.cos(stance.angle) - pull * jnp.sin(stance.angle)
