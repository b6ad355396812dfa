"""Coefficients of the limit friction law: numbers, and how they show themselves."""

import dataclasses
import html
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from .._checks import Real, as_text, has_numbers, require
from .._text import ResultTable, SelfDrawn
from ..bristles import pulling_text
from .conditions import condition_of
from .named_numbers import coefficient_table

OfBristle = Any
"""A traced real scalar, or None in the abstract setting, where there is no bristle."""


class Coefficients(SelfDrawn, eqx.Module):
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
    _picture = "draw_coefficients"

    @property
    def ratio(self) -> Real:
        """`-rho_plus/rho_minus`: how much harder it is to go right than left; NaN where
        there is no friction.

        >>> print(f"{fx.friction(scene).ratio:.4f}")
        1.3689
        """
        return jnp.divide(-self.rho_plus, self.rho_minus)

    def __repr__(self) -> str:
        if not has_numbers(self):
            return super().__repr__()
        known = [(k, v) for k, v in vars(self).items() if v is not None]
        numbers = ", ".join(f"{k}={as_text(v)}" for k, v in known)
        pulls = "" if self.alpha is None else pulling_text(self.alpha)
        condition = condition_of(self)
        said = [pulls] if pulls else []
        said += [condition.words] if condition else []
        shape = np.shape(self.rho_plus)
        batch = f"batch {shape}: " if shape else ""
        return f"Coefficients({batch}{numbers}{''.join(f': {one}' for one in said)})"

    def table(self) -> ResultTable:
        """Each coefficient with its unit and what it means, and its error where known.

        Raises `ValueError` of a batch: one scene's fit into a table.

        >>> fx.friction(scene).table()
        coefficient        value  unit  meaning
        rho_plus        0.120394  N     friction against motion to the right
        rho_minus      -0.087947  N     friction against motion to the left
        ratio            1.36894        -rho_plus/rho_minus
        alpha            1.01644  N     normal force without friction
        normal_plus      1.20394  N     normal force of a slide to the right
        normal_minus     0.87947  N     normal force of a slide to the left
        a               -1.55741        lean of the bristle, A'(0)
        mu_plus         0.118447        largest slope that the bristle sees, friction/alpha
        mu_minus      -0.0865246        smallest slope that the bristle sees, friction/alpha
        omega_plus           0.1        largest slope of the surface, friction/normal force
        omega_minus         -0.1        smallest slope of the surface, friction/normal force
        """
        told = "known numbers: none under a trace"
        require(has_numbers(self), "coefficients", self, told)
        shape = np.shape(self.rho_plus)
        require(not shape, "coefficients", self, "those of one scene, not of a batch")
        return coefficient_table(self)

    def _repr_html_(self) -> str:
        if has_numbers(self) and not np.shape(self.rho_plus):
            return self.table()._repr_html_()
        return f"<pre>{html.escape(repr(self))}</pre>"


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
