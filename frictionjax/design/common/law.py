"""Friction coefficients as functions of extreme slopes and free bristle parameters."""

import abc
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..._checks import Real
from ...bristles import AbstractBristle
from .free_numbers import FreeParameter
from .targets import Geometry, coefficients_of, geometry


class AbstractLaw(eqx.Module):
    """The geometry of each target's bristle, arrays of shape (targets,), at `free`."""

    @abc.abstractmethod
    def at(self, free: Float[Array, " free"]) -> Geometry:
        """`a`, `alpha` and the slopes allowed; `free` in shares of the bounds."""

    def known_at(self, free: Float[Array, " free"]) -> Geometry:
        """The same as NumPy arrays."""
        return jax.tree_util.tree_map(np.asarray, self.at(free))

    def coefficients(
        self, plus: Any, minus: Any, free: Float[Array, " free"]
    ) -> Float[Array, "targets 2"]:
        """`rho_plus`, `rho_minus` in N of slopes `plus` > 0 and -`minus` < 0."""
        return coefficients_of(self.at(free), plus, minus)


class FixedLaw(AbstractLaw):
    """Bristles as they are: one program for bristles of any kind."""

    known: Geometry

    def at(self, free: Float[Array, " free"]) -> Geometry:
        return self.known


class FreeLaw(AbstractLaw):
    """Bristles with free numbers.

    `which`: the bristle of each target; `free`: the numbers with their bristle; `low`,
    `high`: their bounds. `times`: how many of each pull together; None: one.
    """

    bristles: tuple[AbstractBristle, ...]
    which: tuple[int, ...] = eqx.field(static=True)
    free: tuple[tuple[int, FreeParameter], ...] = eqx.field(static=True)
    low: Float[Array, " free"]
    high: Float[Array, " free"]
    times: Real | None = None

    def values(self, free: Float[Array, " free"]) -> Float[Array, " free"]:
        """The numbers themselves, in their own units."""
        return self.low + (self.high - self.low) * free

    def shares(self) -> Float[Array, " free"]:
        """Where the bristles' own numbers lie between the bounds."""
        own = [number.now(self.bristles[index]) for index, number in self.free]
        return (jnp.stack(own) - self.low) / (self.high - self.low)

    def bristles_at(self, free: Float[Array, " free"]) -> tuple[AbstractBristle, ...]:
        """The bristles with these numbers."""
        bristles = list(self.bristles)
        for (index, number), value in zip(self.free, self.values(free), strict=True):
            bristles[index] = number.put(bristles[index], value)
        return tuple(bristles)

    def at(self, free: Float[Array, " free"]) -> Geometry:
        known = [geometry(bristle) for bristle in self.bristles_at(free)]
        known = [one.of_several(self.times) for one in known]
        rows = [known[index] for index in self.which]
        return jax.tree_util.tree_map(lambda *one: jnp.stack(one), *rows)
