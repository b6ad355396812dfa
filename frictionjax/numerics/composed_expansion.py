"""`F(eps W + eps^2 Q) - F(0)` expanded in eps, to its first term and all of the rest."""

from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp

from .._checks import Real
from .taylor import second_remainder


class LeadingTerm(eqx.Module):
    """`W(Y) = alpha WW(Y)` with `alpha = F'(0)` (Lemma 2)."""

    energy: Callable[[Real], Real]
    wiggle: Callable[[Real], Real]

    def alpha(self) -> Real:
        """`F'(0)`."""
        return self._slope(jnp.zeros(()))

    def slopes_beside(self) -> tuple[Real, Real]:
        """F' just below and just above 0: those of a kink differ."""
        near = jnp.asarray(1e-300)
        return self._slope(-near), self._slope(near)

    def _slope(self, u: Real) -> Real:
        def energy(u: Real) -> Real:
            return jnp.asarray(self.energy(u), dtype=float)

        return jax.jvp(energy, (u,), (jnp.ones_like(u),))[1]

    def __call__(self, Y: Real) -> Real:
        return self.alpha() * self.wiggle(Y)


class RestTerm(eqx.Module):
    """`Q(eps; Y) = alpha QQ + (WW + eps QQ)^2 h`, nothing of which cancels.

    h is the second remainder of F at `u = eps WW + eps^2 QQ`: `F(u) = F(0) + alpha u +
    u^2 h(u)`. The square holds what Lemma 2 prints, and the cross term eps F''(0) WW QQ
    that it leaves out.
    """

    leading: LeadingTerm
    rest: Callable[[Real, Real], Real] | None

    def __call__(self, eps: Real, Y: Real) -> Real:
        height = jnp.asarray(self.leading.wiggle(Y))
        lifted = jnp.zeros_like(height)
        if self.rest is not None:
            own = self.rest(eps, Y)
            lifted, height = self.leading.alpha() * own, height + eps * own
        return lifted + height**2 * second_remainder(self.leading.energy, eps * height)
