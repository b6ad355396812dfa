"""Forces in the contact and along the bristle, at finite eps and in the limit."""

from typing import NamedTuple

import jax
import jax.numpy as jnp

from .._checks import Real
from ..bristles import AbstractBristle
from ..model import AbstractPotential, BristlePotential
from ..numerics import slope_of


class TipForces(NamedTuple):
    """At one state: place of the tip, forces in N, the bristle's energy in J.

    `normal`: what the surface presses with, upwards. `tangential`: along x, on the
    bristle; -V_eps'(z). `axial`: along the bristle, traction positive. `angle` in rad and
    `length` in m of the bristle. None where the model has no such quantity.
    """

    tip: Real
    tangential: Real
    energy: Real
    normal: Real | None = None
    angle: Real | None = None
    length: Real | None = None
    axial: Real | None = None


def tip_forces(potential: AbstractPotential, z: Real, eps: Real) -> TipForces:
    """Of the state z (m) at eps.

    The contact is frictionless: its force `N (-w', 1)` is perpendicular to the surface,
    and `N = F'(eta)/(1 + A'(eta) w')`.
    """
    number, inside = potential.tip(z, eps)
    pull, stretch = potential.tip_force(inside, eps)
    tip = eps * (number + inside)
    if not isinstance(potential, BristlePotential):
        return TipForces(tip, -pull, potential.tip_energy(inside, eps))
    bristle = potential.bristle
    eta = eps * potential.profile(inside)
    energy, climb = jax.value_and_grad(bristle.energy)(eta)
    known = TipForces(tip, -pull, energy, climb / stretch)
    return _along(bristle, eta, known)


def limit_forces(potential: AbstractPotential, z: Real, force: Real) -> TipForces:
    """Of the limit state z (m) with the friction `force` on it, `l - Phi'(z)` in N.

    Its tips stand where the surface's slope gives that force, `N w' = force`, so
    `N = alpha - a force`, on slides and at rest; their places are those of the state.
    """
    zero = jnp.zeros_like(z)
    if not isinstance(potential, BristlePotential):
        return TipForces(z, -force, zero)
    bristle = potential.bristle
    normal = slope_of(bristle.energy)(zero) - slope_of(bristle.offset)(zero) * force
    return _along(bristle, zero, TipForces(z, -force, bristle.energy(zero), normal))


def _along(bristle: AbstractBristle, eta: Real, forces: TipForces) -> TipForces:
    """With the geometry of the bristle and the force along it, where it has one.

    The rod points from its tip to its root, (sin theta, cos theta); what the surface
    presses along that is compression.
    """
    known = bristle.geometry(eta)
    if known is None:
        return forces
    normal = jnp.asarray(forces.normal)
    pressed = normal * jnp.cos(known.angle) + forces.tangential * jnp.sin(known.angle)
    return forces._replace(angle=known.angle, length=known.length, axial=-pressed)
