"""The wiggly potential of several tips on one root."""

from collections.abc import Callable

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from .._checks import Real
from .potentials import AbstractPotential


class SummedPotential(AbstractPotential):
    """`sum_i weight_i V_eps(z + eps offset_i)`, z its own tip coordinate.

    `single`: the potential of one. `offsets` in periods and `weights`, shape (n,).
    """

    single: AbstractPotential
    offsets: Float[Array, " n"]
    weights: Float[Array, " n"]

    def _total(self, of_one: Callable[[Real], Real], Y: Real) -> Real:
        """Of a 1-periodic function of one tip's phase, told where |phase| <= 1/2."""

        def at(offset: Real) -> Real:
            phase = Y + offset
            return of_one(phase - jnp.round(phase))

        return jnp.sum(self.weights * jax.vmap(at)(self.offsets))

    def offset(self, y: Real, eps: Real) -> Real:
        return jnp.zeros_like(y)

    def tip_energy(self, y: Real, eps: Real) -> Real:
        def of_one(Y: Real) -> Real:
            return self.single.tip_energy(self.single.well_coordinate(Y, eps), eps)

        return self._total(of_one, y)

    def tip_energy_change(self, y: Real, eps: Real) -> Real:
        return self.tip_energy(y, eps)

    def well_coordinate(self, Y: Real, eps: Real) -> Real:
        return Y

    def _leading(self, Y: Real) -> Real:
        return self._total(self.single._leading, Y)

    def _rest(self, eps: Real, Y: Real) -> Real:
        return self._total(lambda phase: self.single._rest(eps, phase), Y)

    @property
    def points(self) -> int:
        return self.single.points
