"""Bristle of which only the leading order is left."""

from typing import ClassVar

import equinox as eqx

from .._checks import Asked, Real, as_real, require_real
from .bristle import AbstractBristle


class Linear(AbstractBristle):
    """`A = a eta`, `F = alpha eta`: any bristle as it is for eps -> 0, at every eps.

    `a`: A'(0), how far the state moves ahead of the tip per height. `alpha`: F'(0) in N,
    not 0.

    Raises `ValueError` for numbers that are not finite, and alpha that is 0.

    >>> law = fx.friction(scene)
    >>> same = fx.friction(scene.profile, fx.bristles.Linear(a=law.a, alpha=law.alpha))
    >>> print(f"rho = {same.rho_plus:.4f} N, {same.rho_minus:.4f} N")
    rho = 0.1204 N, -0.0879 N
    """

    asked: ClassVar = {
        "a": Asked("no unit", "any, with 1 + a w' positive on the surface"),
        "alpha": Asked("N", "not 0"),
    }

    a: Real = eqx.field(converter=as_real)
    alpha: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        require_real("bristle.a", self.a, "a number")
        require_real("bristle.alpha", self.alpha, "alpha != 0", lambda v: v != 0)

    def offset(self, eta: Real) -> Real:
        return self.a * eta

    def energy(self, eta: Real) -> Real:
        return self.alpha * eta
