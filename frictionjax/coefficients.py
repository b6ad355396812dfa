"""Friction coefficients of the limit system (Lemma 2, Lemma 3)."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp

from .arguments import Real, as_text, is_known
from .bristles.pulling import pulling_text
from .extrema import periodic_extrema, slope_of
from .potentials import AbstractPotential, BristlePotential
from .programs import Program

OfBristle = Any
"""A traced real scalar, or None in the abstract setting, where there is no bristle."""


class Coefficients(eqx.Module):
    """Coefficients of the limit friction law; all but rho are None without a bristle.

    `alpha`: normal force F'(0) in N. `a`: A'(0). `omega_plus`, `omega_minus`: extreme
    slopes of the surface. `mu_plus`, `mu_minus`: extreme slopes as the bristle sees them.
    `rho_plus` > 0 > `rho_minus`: friction forces in N against motion to the right and to
    the left.
    """

    rho_plus: Real
    rho_minus: Real
    alpha: OfBristle = None
    a: OfBristle = None
    omega_plus: OfBristle = None
    omega_minus: OfBristle = None
    mu_plus: OfBristle = None
    mu_minus: OfBristle = None

    def __repr__(self) -> str:
        if not is_known(self):
            return super().__repr__()
        known = [(k, v) for k, v in vars(self).items() if v is not None]
        numbers = ", ".join(f"{k}={as_text(v)}" for k, v in known)
        pulls = "" if self.alpha is None else pulling_text(self.alpha)
        return f"Coefficients({numbers}{f': {pulls}' if pulls else ''})"


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
    return Coefficients(
        rho_plus=jnp.where(alpha > 0, alpha * mu_plus, alpha * mu_minus),
        rho_minus=jnp.where(alpha > 0, alpha * mu_minus, alpha * mu_plus),
        alpha=alpha,
        a=a,
        omega_plus=extrema.max,
        omega_minus=extrema.min,
        mu_plus=mu_plus,
        mu_minus=mu_minus,
    )


coefficients_jit = Program(coefficients)
