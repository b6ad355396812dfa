"""Two tips on one surface, a spring between them: their equations, and one step of them."""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import Real
from ..loads import AbstractPull
from ..model import AbstractPotential
from ..wiggly import Tableau

FeetMotion = Float[Array, "4"]
"""The tips of the rear and of the front foot in periods from their wells, and in J since
the start `int eps^gamma (x1'^2 + x2'^2)` and `int l (x2' - x1')`, which needs no slope of
l, that jumps where l has kinks."""


class FootForces(NamedTuple):
    """Of both feet: `V_eps'` in N, `G = dz/dp`, and the place z in m, shape (2,)."""

    pull: Array
    stretch: Array
    place: Array


class TwoFeet(eqx.Module):
    """`eps^gamma x1' = T - V_eps'(x1)`, `eps^gamma x2' = -T - V_eps'(x2)`.

    `T = k (x2 - x1) - l(t)` in N, with `l = k L`, pulls both together. `wells`: from which
    tips are counted, (2,); `origin` (s): from which time is. `viscosity`: eps^gamma.
    """

    potential: AbstractPotential
    load: AbstractPull
    stiffness: Real
    eps: Real
    viscosity: Real
    wells: Float[Array, "2"]
    origin: Real

    def feet(self, motion: FeetMotion) -> FootForces:
        """With one look at the surface for each."""
        look = jax.vmap(lambda y: self.potential.at_tip(y, self.eps))
        pull, stretch, offset = look(motion[:2])
        return FootForces(pull, stretch, self.eps * (self.wells + motion[:2]) + offset)

    def tension(self, t: Real, feet: FootForces) -> Real:
        """T in N."""
        longer = feet.place[1] - feet.place[0]
        return self.stiffness * longer - self.load(self.origin + t)

    def rates(self, t: Real, motion: FeetMotion) -> FeetMotion:
        """Time derivatives of all four."""
        feet = self.feet(motion)
        tension = self.tension(t, feet)
        force = tension * jnp.array([1.0, -1.0]) - feet.pull
        tips = force / (self.viscosity * self.eps * feet.stretch)
        lost = jnp.sum(force**2) / self.viscosity
        work = self.load(self.origin + t) * (force[1] - force[0]) / self.viscosity
        return jnp.append(tips, jnp.stack([lost, work]))

    def energy(self, motion: FeetMotion) -> Real:
        """`k (x2 - x1)^2/2` and of both feet, in J: the load l does the rest."""
        places = self.feet(motion).place
        wiggle = jax.vmap(lambda y: self.potential.tip_energy_change(y, self.eps))
        spring = 0.5 * self.stiffness * (places[1] - places[0]) ** 2
        return spring + jnp.sum(wiggle(motion[:2]))


class FeetStep(NamedTuple):
    """Where a step ends, and its error."""

    end: FeetMotion
    error: FeetMotion


def step_of_feet(
    tableau: Tableau,
    rates: Callable[[Real, FeetMotion], FeetMotion],
    t: Real,
    size: Real,
    start: FeetMotion,
) -> FeetStep:
    """One step of a Rosenbrock method of `size` s, as `rosenbrock_step` makes of one tip.

    Nothing comes back from the two energies, so only the tips are solved for, by Cramer's
    rule, and energies follow.
    """
    by_time, by_tips = _slopes(rates, t, start)
    rate = 1 / (size * tableau.gamma)
    first, second = rate - by_tips[0, 0], rate - by_tips[1, 1]
    across = by_tips[0, 1], by_tips[1, 0]
    whole = first * second - across[0] * across[1]
    zero = jnp.zeros_like(start)

    def solved(push: FeetMotion) -> FeetMotion:
        rear = (second * push[0] + across[0] * push[1]) / whole
        front = (first * push[1] + across[1] * push[0]) / whole
        rest = (push[2:] + by_tips[2:] @ jnp.stack([rear, front])) / rate
        return jnp.append(jnp.stack([rear, front]), rest)

    def stage(carry: tuple, row: tuple) -> tuple[tuple, None]:
        before, _ = carry
        a, c, time, time_derivative = row
        inside = start + a @ before
        push = rates(t + time * size, inside) + (c @ before) / size
        found = solved(push + size * time_derivative * by_time)
        return (jnp.concatenate([before[1:], found[None]]), inside), None

    none = jnp.zeros((len(tableau.times) - 1, *start.shape))
    (stages, inside), _ = jax.lax.scan(stage, (none, zero), _rows(tableau))
    return FeetStep(inside + stages[-1], stages[-1])


def _slopes(
    rates: Callable[[Real, FeetMotion], FeetMotion], t: Real, at: FeetMotion
) -> tuple[FeetMotion, Float[Array, "4 2"]]:
    """Derivatives of the rates by time, and by both tips."""

    def moved(ahead: Float[Array, "3"]) -> FeetMotion:
        tips = jnp.append(ahead[1:], jnp.zeros(2))
        return jax.jvp(rates, (t, at), (ahead[0], tips))[1]

    found = jax.vmap(moved)(jnp.eye(3))
    return found[0], found[1:].T


def _rows(tableau: Tableau) -> Any:
    """Of each stage: weights of those before it, padded in front, and its times."""
    count = len(tableau.times) - 1
    a, c = (
        np.array([(0.0,) * (count - len(row)) + tuple(row) for row in rows])
        for rows in (tableau.a, tableau.c)
    )
    return a, c, np.array(tableau.times), np.array(tableau.time_derivative)
