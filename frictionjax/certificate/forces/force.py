"""The force on a tip: of its coordinate, in which nothing is inverted between samples."""

import abc
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp

from ..._checks import Real
from ...loads import AbstractPull
from ...model import AbstractPotential, Scene
from ...supports import AbstractSupport


class ForceParts(NamedTuple):
    """What drives a tip: f and `V'` in N, and dz/dy in m."""

    force: Real
    wiggle: Real
    stretch: Real


class AtTip(NamedTuple):
    """`V'` in N, `dz/dp`, and z in m, of a tip."""

    wiggle: Real
    stretch: Real
    state: Real


class AbstractForce(eqx.Module):
    """`f(t, z) = l(t) - Phi'(z) - V'(z)` in N where the tip is at well + y.

    In the tip coordinate nothing is inverted between samples, and y counted from a well
    nearby keeps all digits at any z/eps.
    """

    support: eqx.AbstractVar[AbstractSupport]
    load: eqx.AbstractVar[AbstractPull]
    eps: eqx.AbstractVar[Real]

    @abc.abstractmethod
    def tip(self, z: Real) -> tuple[Real, Real]:
        """Well and y at a state in m."""

    @abc.abstractmethod
    def at_tip(self, well: Real, y: Real) -> AtTip:
        """All that there is to know of a tip, with one look at the surface."""

    def state(self, well: Real, y: Real) -> Real:
        """z in m."""
        return self.at_tip(well, y).state

    def pull(self, y: Real) -> tuple[Real, Real]:
        """`V'` in N, and `dz/dp`."""
        wiggle, stretch, _ = self.at_tip(jnp.zeros_like(y), y)
        return wiggle, stretch

    def stretch(self, y: Real) -> Real:
        """`dz/dy` in m."""
        return self.eps * self.pull(y)[1]

    def driven(self, t: Real, well: Real, y: Real) -> ForceParts:
        """The force, and what it is made of."""
        at = self.at_tip(well, y)
        force = self.load(t) - self.support.force(at.state) - at.wiggle
        return ForceParts(force, at.wiggle, self.eps * at.stretch)

    def with_slope(self, t: Real, well: Real, y: Real) -> tuple[ForceParts, Real]:
        """f and what it is made of, and `f_z`."""

        def along(s: Real) -> tuple[Real, ForceParts]:
            driven = self.driven(t, well, s)
            return driven.force, driven

        one = jnp.ones_like(y)
        _, by_tip, driven = jax.jvp(along, (y,), (one,), has_aux=True)
        return driven, by_tip / driven.stretch


class Force(AbstractForce):
    """Of a tip on the surface: V is `V_eps`."""

    potential: AbstractPotential
    support: AbstractSupport
    load: AbstractPull
    eps: Real

    def tip(self, z: Real) -> tuple[Real, Real]:
        return self.potential.tip(z, self.eps)

    def at_tip(self, well: Real, y: Real) -> AtTip:
        wiggle, stretch, offset = self.potential.at_tip(y, self.eps)
        return AtTip(wiggle, stretch, self.eps * (well + y) + offset)


def force_of(scene: Scene, eps: Real) -> Force:
    """The driving force of a scene at one eps."""
    return Force(potential=scene.potential, support=scene.support, load=scene.load, eps=eps)
