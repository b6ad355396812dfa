"""What a support is."""

import abc

import jax

from .._checks import Part, Real

_NEWTON = 3


class AbstractSupport(Part):
    """The energy `Phi(z)` of the horizontal spring, uniformly convex.

    >>> spring = scene.support
    >>> print(f"{spring.force(0.5):.2f} N at 0.5 m, {spring.state_of(0.3):.2f} m at 0.3 N")
    0.50 N at 0.5 m, 0.30 m at 0.3 N
    """

    @abc.abstractmethod
    def energy(self, z: Real) -> Real:
        """`Phi(z)` in J."""

    @abc.abstractmethod
    def state_of(self, force: Real) -> Real:
        """`(Phi')^-1(force)` in m, differentiable in `force` (N) and parameters."""

    def state_near(self, force: Real, guess: Real) -> Real:
        """`state_of` for a state near `guess` in m, without a search for it.

        A guess a tenth of its scale off leaves 1e-10 of it.
        """
        for _ in range(_NEWTON):
            guess = guess + (force - self.force(guess)) / self.stiffness_at(guess)
        return guess

    def force(self, z: Real) -> Real:
        """`Phi'(z)` in N."""
        return jax.grad(self.energy)(z)

    def stiffness_at(self, z: Real) -> Real:
        """`Phi''(z)` in N/m."""
        return jax.grad(jax.grad(self.energy))(z)
