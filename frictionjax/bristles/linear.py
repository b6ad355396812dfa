"""Bristle of which only the leading order is left."""

import equinox as eqx

from .._checks import Real, as_real
from .bristle import AbstractBristle


class Linear(AbstractBristle):
    """`A = a eta`, `F = alpha eta`: a bristle for eps -> 0, at every eps.

    `a`: A'(0). `alpha`: F'(0) in N.
    """

    a: Real = eqx.field(converter=as_real)
    alpha: Real = eqx.field(converter=as_real)

    def offset(self, eta: Real) -> Real:
        return self.a * eta

    def energy(self, eta: Real) -> Real:
        return self.alpha * eta
