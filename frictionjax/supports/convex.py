"""Support given as a function."""

from collections.abc import Callable
from typing import ClassVar

import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from .._checks import Real, require_function
from ..numerics import increasing_root
from .support import AbstractSupport, of_each


class Convex(AbstractSupport):
    """The support with energy `Phi = energy_fn`, C^2 and uniformly convex, in J.

    `energy`: Phi, scalar to scalar, written with `jax.numpy`. That `Phi'' > 0` is checked
    by the scene, on the range of z that its load reaches.

    >>> stiffening = fx.supports.Convex(lambda z: z**2 / 2 + z**4)
    >>> print(f"{stiffening.force(0.5):.2f} N, {stiffening.stiffness_at(0.5):.2f} N/m")
    1.00 N, 4.00 N/m
    """

    _stored: ClassVar = {"energy": "energy_fn"}

    energy_fn: Callable[[Real], Real]

    def __init__(self, energy: Callable[[Real], Real]):
        self.energy_fn = energy

    def __check_init__(self):
        require_function("support.energy", self.energy_fn, "a function Phi of z")

    def energy(self, z: Real) -> Real:
        return jnp.asarray(self.energy_fn(z))

    def state_of(self, force: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return of_each(self._state_of, force)

    def _state_of(self, force: Real) -> Real:
        return increasing_root(lambda z: self.force(z) - force, jnp.zeros_like(force))
