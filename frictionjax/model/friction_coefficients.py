"""Friction coefficients of the limit system (Lemma 2, Lemma 3)."""

import dataclasses
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from .._checks import ByIdentity, Real, as_text, is_concrete, is_known
from .._compile import Program
from ..bristles import pulling_text
from ..numerics import periodic_extrema, slope_of
from .potentials import AbstractPotential, BristlePotential
from .summed_potential import SummedPotential
from .tabulated_potential import cancels, potential_at_rest

OfBristle = Any
"""A traced real scalar, or None in the abstract setting, where there is no bristle."""


class Coefficients(eqx.Module):
    """Coefficients of the limit friction law; all but rho are None without a bristle.

    `rho_plus` > 0 > `rho_minus`: friction forces in N against motion to the right and to
    the left. `alpha`: F'(0) in N, the normal force without friction. `normal_plus`,
    `normal_minus`: the normal force in N where the surface resists most, on a slide to the
    right and to the left. `a`: A'(0). `omega_plus`, `omega_minus`: extreme slopes of the
    surface. `mu_plus`, `mu_minus`: extreme slopes as the bristle sees them.

    The contact is frictionless, so its force is perpendicular to the surface, and friction
    over normal force is the slope there: `rho_plus/normal_plus = omega_plus` and
    `rho_minus/normal_minus = omega_minus` for alpha > 0, the other way round for
    alpha < 0, for every bristle. `normal = alpha - a rho`: on a symmetric surface friction
    depends on direction only because the normal force does. (The paper calls alpha the
    normal force, and mu = rho/alpha is friction per normal force at rest only.)

    `omega_plus_error` and the like: how far off they may be where the surface is known by
    samples (`SlopeErrors`); None where it is exact, or nothing says so. `omega_plus_taken`
    and `omega_minus_taken`: part of these, what a smoothing filter has taken off.
    """

    rho_plus: Real
    rho_minus: Real
    alpha: OfBristle = None
    a: OfBristle = None
    omega_plus: OfBristle = None
    omega_minus: OfBristle = None
    mu_plus: OfBristle = None
    mu_minus: OfBristle = None
    normal_plus: OfBristle = None
    normal_minus: OfBristle = None
    omega_plus_error: OfBristle = None
    omega_minus_error: OfBristle = None
    rho_plus_error: OfBristle = None
    rho_minus_error: OfBristle = None
    omega_plus_taken: OfBristle = None
    omega_minus_taken: OfBristle = None

    def __repr__(self) -> str:
        if not is_known(self):
            return super().__repr__()
        known = [(k, v) for k, v in vars(self).items() if v is not None]
        numbers = ", ".join(f"{k}={as_text(v)}" for k, v in known)
        pulls = "" if self.alpha is None else pulling_text(self.alpha)
        shape = np.shape(self.rho_plus)
        batch = f"batch {shape}: " if shape else ""
        return f"Coefficients({batch}{numbers}{f': {pulls}' if pulls else ''})"


def coefficients(potential: AbstractPotential) -> Coefficients:
    """Coefficients of a potential, without checks; traceable and differentiable."""
    if not isinstance(potential, BristlePotential):
        slope = slope_of(potential._leading)
        extrema = periodic_extrema(slope, potential.points)
        return Coefficients(rho_plus=extrema.max, rho_minus=extrema.min)
    slope = slope_of(potential.profile)
    extrema = periodic_extrema(slope, potential.points)
    a, alpha = potential.a(), potential.alpha()
    mu_plus = extrema.max / (1 + a * extrema.max)  # Lemma 3
    mu_minus = extrema.min / (1 + a * extrema.min)
    rho_plus = jnp.where(alpha > 0, alpha * mu_plus, alpha * mu_minus)
    rho_minus = jnp.where(alpha > 0, alpha * mu_minus, alpha * mu_plus)
    return Coefficients(
        rho_plus=rho_plus,
        rho_minus=rho_minus,
        alpha=alpha,
        a=a,
        omega_plus=extrema.max,
        omega_minus=extrema.min,
        mu_plus=mu_plus,
        mu_minus=mu_minus,
        normal_plus=alpha - a * rho_plus,  # = F'(0)/(1 + a omega), the steepest place's
        normal_minus=alpha - a * rho_minus,
    )


def with_errors(found: Coefficients, plus: Real, minus: Real) -> Coefficients:
    """The coefficients with errors of the steepest slopes, and of rho by these.

    `d rho/d omega = alpha/(1 + a omega)^2`, an end at a time.
    """
    by_plus = jnp.abs(found.alpha) * plus / (1 + found.a * found.omega_plus) ** 2
    by_minus = jnp.abs(found.alpha) * minus / (1 + found.a * found.omega_minus) ** 2
    presses = found.alpha > 0
    return dataclasses.replace(
        found,
        omega_plus_error=plus,
        omega_minus_error=minus,
        rho_plus_error=jnp.where(presses, by_plus, by_minus),
        rho_minus_error=jnp.where(presses, by_minus, by_plus),
    )


_of_tables = Program(coefficients)
_FOUND = ByIdentity()  # coefficients of potentials that are known


def coefficients_jit(potential: AbstractPotential) -> Coefficients:
    """The same, compiled once for all potentials of known numbers; found once of each."""
    found = _FOUND.get(potential)
    if found is None and cancels(potential):
        found = Coefficients(jnp.zeros(()), jnp.zeros(()))
        _FOUND.put(potential, found)
    if found is None:
        found = _of_tables(potential_at_rest(potential))
        if isinstance(potential, SummedPotential):  # of no bristle
            found = Coefficients(found.rho_plus, found.rho_minus)
        if is_concrete(potential):
            _FOUND.put(potential, found)
    return found
