"""Friction coefficients of the limit system (Lemma 2, Lemma 3)."""

import dataclasses

import jax.numpy as jnp

from .._checks import ByIdentity, is_concrete
from .._compile import once_a_scene
from ..coefficients import Coefficients
from ..numerics import periodic_extrema, slope_of
from .potentials import AbstractPotential, BristlePotential, GivenPotential
from .summed_potential import SummedPotential
from .tabulated_potential import cancels, potential_at_rest


def coefficients(potential: AbstractPotential) -> Coefficients:
    """Coefficients of a potential, without checks; traceable and differentiable."""
    if not isinstance(potential, BristlePotential):
        slope = slope_of(potential._leading)
        extrema = periodic_extrema(slope, potential.points)
        found = Coefficients(rho_plus=extrema.max, rho_minus=extrema.min)
        return _with_alpha(found, potential)
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


def _with_alpha(found: Coefficients, potential: AbstractPotential) -> Coefficients:
    """mu_plus > 0 > mu_minus, of rho = alpha mu: alpha < 0 exchanges them (Lemma 2)."""
    alpha = potential.alpha() if isinstance(potential, GivenPotential) else None
    if alpha is None:
        return found
    ends = found.rho_plus / alpha, found.rho_minus / alpha
    pushes = alpha > 0
    return dataclasses.replace(
        found,
        alpha=alpha,
        mu_plus=jnp.where(pushes, *ends),
        mu_minus=jnp.where(pushes, *ends[::-1]),
    )


_of_tables = once_a_scene(coefficients)
_FOUND = ByIdentity()  # coefficients of potentials that are known


def coefficients_jit(potential: AbstractPotential) -> Coefficients:
    """The same, compiled once for all potentials of known numbers; found once of each."""
    found = _FOUND.get(potential)
    if found is None and cancels(potential):
        found = Coefficients(jnp.zeros(()), jnp.zeros(()))
        _FOUND.put(potential, found)
    if found is None:
        found = _of_tables(potential_at_rest(potential))
        if isinstance(potential, SummedPotential | GivenPotential):  # of no bristle
            found = Coefficients(found.rho_plus, found.rho_minus)
        found = _with_alpha(found, potential)
        if is_concrete(potential):
            _FOUND.put(potential, found)
    return found
