"""Vector field of the wiggly system in the tip coordinate."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp

from ..._checks import Real
from ...loads import AbstractPull
from ...model import AbstractPotential
from ...supports import AbstractSupport


class Point(NamedTuple):
    """The field at one point: `y'`, its derivatives by `y` and `t`, `z` in m, `G`, and the
    load in N."""

    velocity: Real
    by_state: Real
    by_time: Real
    state: Real
    stretch: Real
    load: Real


class Driven(NamedTuple):
    """What drives a tip: `l - Phi' - V_eps'` in N, `G`, `z` in m, and the load in N."""

    force: Real
    stretch: Real
    state: Real
    load: Real


class TipField(eqx.Module):
    """`eps^gamma z' = l(t) - Phi'(z) - V_eps'(z)` (eq. 2.8) for the tip `y = p/eps`.

    In y nothing has to be inverted:
    `y' = (l(t) - Phi'(eps y + A) - V_eps') / (eps^(gamma+1) G)`, `G = dz/dp`.

    `y` is counted from the well with the number `well` and `t` from `origin` (s), so that
    neither loses digits at eps = 1e-8. `viscosity`: `eps^gamma` in N s/m.
    """

    potential: AbstractPotential
    support: AbstractSupport
    load: AbstractPull
    eps: Real
    viscosity: Real
    well: Real | float = 0.0
    origin: Real | float = 0.0

    def state(self, y: Real) -> Real:
        """`z = p + A(w_eps(p))` in m."""
        return self.eps * (self.well + y) + self.potential.offset(y, self.eps)

    def start(self, z: Real) -> Real:
        """The tip coordinate of the state `z`."""
        number, inside = self.potential.tip(z, self.eps)
        return number + inside

    def load_slope(self, t: Real) -> Real:
        """`l'(t)` in N/s."""
        return self.load.slope(self.origin + t)

    def driven(self, t: Real, y: Real) -> Driven:
        """The force and what it is made of, with one look at the surface."""
        wiggle, stretch, offset = self.potential.at_tip(y, self.eps)
        state = self.eps * (self.well + y) + offset
        load = self.load(self.origin + t)
        return Driven(load - self.support.force(state) - wiggle, stretch, state, load)

    def driving_force(self, t: Real, y: Real) -> tuple[Real, Real]:
        """`l - Phi' - V_eps'` in N, and `G`."""
        force, stretch, _, _ = self.driven(t, y)
        return force, stretch

    def velocity(self, t: Real, y: Real) -> Real:
        """`y'` in periods per second."""
        force, stretch = self.driving_force(t, y)
        return force / (self.viscosity * self.eps * stretch)

    def dissipated_power(self, t: Real, y: Real) -> Real:
        """`eps^gamma z'^2` in W."""
        force, _ = self.driving_force(t, y)
        return force**2 / self.viscosity

    def point(self, t: Real, y: Real) -> Point:
        """The field and its derivatives at one point."""
        one = jnp.ones_like(y)

        def moved(s: Real) -> tuple[Real, Driven]:
            driven = self.driven(t, s)
            drag = self.viscosity * self.eps * driven.stretch
            return driven.force / drag, driven

        velocity, by_state, driven = jax.jvp(moved, (y,), (one,), has_aux=True)
        by_time = self.load_slope(t) / (self.viscosity * self.eps * driven.stretch)
        return Point(
            velocity=velocity,
            by_state=by_state,
            by_time=by_time,
            state=driven.state,
            stretch=driven.stretch,
            load=driven.load,
        )

    def energy(self, t: Real, y: Real) -> Real:
        """`E_eps = Phi - l z + V_eps` (eq. 2.4) in J."""
        z = self.state(y)
        # Differences of energies over a scene lose nothing that the quadrature in
        # `tip_energy` could keep, and this one runs every step.
        wiggle = self.potential.tip_energy_change(y, self.eps)
        return self.support.energy(z) - self.load(self.origin + t) * z + wiggle
