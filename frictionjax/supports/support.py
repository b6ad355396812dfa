"""What a support is."""

import abc
from collections.abc import Callable

import jax
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from .._checks import Part, Real, is_foreign, require_function

_NEWTON = 3


class AbstractSupport(Part):
    """The energy `Phi(z)` of the horizontal spring, uniformly convex.

    Of a class of your own it is checked where it is made that JAX traces it.

    >>> spring = scene.support
    >>> print(f"{spring.force(0.5):.2f} N at 0.5 m, {spring.state_of(0.3):.2f} m at 0.3 N")
    0.50 N at 0.5 m, 0.30 m at 0.3 N
    >>> print(spring.force(np.array([0.0, 0.5, 1.0])))
    [0.  0.5 1. ]
    """

    def __check_init__(self):
        if is_foreign(self):
            kind = f"support: {type(self).__name__}"
            require_function(f"{kind}.energy", self.energy, "a function Phi of z")
            require_function(f"{kind}.state_of", self.state_of, "a function of a force")

    @abc.abstractmethod
    def energy(self, z: Real) -> Real:
        """`Phi(z)` in J."""

    @abc.abstractmethod
    def state_of(self, force: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        """`(Phi')^-1(force)` in m, differentiable in `force` (N) and parameters."""

    def state_near(self, force: Real, guess: Real) -> Real:
        """`state_of` for a state near `guess` in m, without a search for it.

        A guess a tenth of its scale off leaves 1e-10 of it.
        """
        for _ in range(_NEWTON):
            guess = guess + (force - self.force(guess)) / self.stiffness_at(guess)
        return guess

    def force(self, z: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        """`Phi'(z)` in N, of `z` in m or an array of them."""
        return of_each(jax.grad(self.energy), z)

    def stiffness_at(self, z: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        """`Phi''(z)` in N/m, of `z` in m or an array of them."""
        return of_each(jax.grad(jax.grad(self.energy)), z)


def of_each(fn: Callable, values: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
    """`fn`, of scalars, of each of the values; of a scalar the very program that it was."""
    return jnp.vectorize(fn)(values) if jnp.ndim(values) else fn(values)
