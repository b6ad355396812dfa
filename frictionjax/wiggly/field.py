"""Vector field of the wiggly system in the tip coordinate."""

import equinox as eqx
import jax
import jax.numpy as jnp

from ..arguments import Real
from ..loads import AbstractLoad
from ..potentials import AbstractPotential
from ..supports import AbstractSupport


class TipField(eqx.Module):
    """`eps^gamma z' = l(t) - Phi'(z) - V_eps'(z)` (eq. 2.7) for the tip `y = p/eps`.

    In y nothing has to be inverted:
    `y' = (l(t) - Phi'(eps y + A) - V_eps') / (eps^(gamma+1) G)`, `G = dz/dp`.
    """

    potential: AbstractPotential
    support: AbstractSupport
    load: AbstractLoad
    eps: Real
    gamma: Real

    @property
    def viscosity(self) -> Real:
        """`eps^gamma`, in N s/m."""
        return self.eps**self.gamma

    def state(self, y: Real) -> Real:
        """`z = p + A(w_eps(p))` in m."""
        return self.eps * y + self.potential.offset(y, self.eps)

    def start(self, z: Real) -> Real:
        """The tip coordinate of the state `z`."""
        number, inside = self.potential.tip(z, self.eps)
        return number + inside

    def driving_force(self, t: Real, y: Real) -> tuple[Real, Real]:
        """`l - Phi' - V_eps'` in N, and `G`."""
        wiggle, stretch = self.potential.tip_force(y, self.eps)
        force = self.load(t) - self.support.force(self.state(y)) - wiggle
        return force, stretch

    def velocity(self, t: Real, y: Real) -> Real:
        """`y'` in periods per second."""
        force, stretch = self.driving_force(t, y)
        return force / (self.viscosity * self.eps * stretch)

    def linearised(self, t: Real, y: Real) -> tuple[Real, Real, Real]:
        """`y'` and its derivatives with respect to `y` and `t`."""
        one = jnp.ones_like(y)
        velocity, by_state = jax.jvp(lambda s: self.velocity(t, s), (y,), (one,))
        _, stretch = self.potential.tip_force(y, self.eps)
        by_time = self.load.slope(t) / (self.viscosity * self.eps * stretch)
        return velocity, by_state, by_time

    def energy(self, t: Real, y: Real) -> Real:
        """`E_eps = Phi - l z + V_eps` (eq. 2.6) in J."""
        z = self.state(y)
        # Differences of energies over a scene lose nothing that the quadrature in
        # `tip_energy` could keep, and this one runs every step.
        wiggle = self.potential.tip_energy_change(y, self.eps)
        return self.support.energy(z) - self.load(t) * z + wiggle
