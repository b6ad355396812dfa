"""Wiggly potentials of tables: what programs are compiled for, once a size."""

from typing import Any

import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from .._checks import ByIdentity, is_concrete
from ..profiles import AbstractProfile
from ..tables import (
    ProfileTables,
    bristle_at_rest,
    bristle_series,
    energy_of_height,
    profile_tables,
)
from .potentials import AbstractPotential, BristlePotential, GivenPotential, no_rest
from .summed_potential import SummedPotential
from .summed_series import leaves_nothing, surface_of_sum

_MARGIN = 1.01  # heights beyond those of the samples


class _LeadingHeight(AbstractProfile):
    """W of a given potential, as the height of a surface."""

    given: GivenPotential

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        y = jnp.asarray(y)
        return jnp.asarray(self.given.W_fn(y - jnp.floor(y)))

    @property
    def points(self) -> int:
        return self.given.points


_HEIGHTS = ByIdentity()  # of given potentials: tables of W, None where none holds it


def _tables_of(given: GivenPotential) -> ProfileTables | None:
    """Tables of its W, whatever its Q; None where no table holds it."""
    known = _HEIGHTS.get(given)
    if known is None:
        tables = profile_tables(_LeadingHeight(given))
        known = (tables if tables.is_table else None,)
        _HEIGHTS.put(given, known)
    return known[0]


def potential_at_rest(potential: AbstractPotential) -> AbstractPotential:
    """A known potential as its coefficients see it, eps -> 0; itself without a table."""
    if not is_concrete(potential):
        return potential
    if isinstance(potential, SummedPotential):
        one = surface_of_sum(potential, potential_at_rest(potential.single), 0.0)
        return potential_at_rest(one)
    if isinstance(potential, GivenPotential):
        tables = _tables_of(potential)
        if tables is None:
            return potential
        return BristlePotential(tables.planning, bristle_at_rest(energy_of_height()))
    if not isinstance(potential, BristlePotential):
        return potential
    tables = profile_tables(potential.profile)
    return BristlePotential(tables.planning, bristle_at_rest(potential.bristle))


def cancels(potential: AbstractPotential) -> bool:
    """Whether several tips of a known potential leave no friction for eps -> 0."""
    if not isinstance(potential, SummedPotential) or not is_concrete(potential):
        return False
    return leaves_nothing(potential, potential_at_rest(potential.single))


def tabulated_potentials(
    potential: AbstractPotential, highest: float
) -> tuple[AbstractPotential, AbstractPotential]:
    """A known potential for eps up to `highest` (m): as planning evaluates it, and lanes.

    `eps W` is the energy of a tip that its height moves nowhere; what is given with a Q is
    itself. A sum of several tips' is that at `highest`, and at no other eps.
    """
    if isinstance(potential, SummedPotential):
        single, _ = tabulated_potentials(potential.single, highest)
        potential = surface_of_sum(potential, single, highest)
    tables: ProfileTables | None = None
    if isinstance(potential, BristlePotential):
        tables = profile_tables(potential.profile)
        bristle = bristle_series(potential.bristle, _MARGIN * highest * tables.height)
    elif isinstance(potential, GivenPotential) and potential.Q_fn is no_rest:
        tables, bristle = _tables_of(potential), energy_of_height()
    if tables is None:
        return potential, potential
    shapes = tables.planning, tables.lanes
    planning, lanes = (BristlePotential(shape, bristle) for shape in shapes)
    return planning, lanes


def potential_in_reach(potential: AbstractPotential, highest: Any) -> AbstractPotential:
    """As planning evaluates it, and with the rod that it is, where it is one."""
    if not isinstance(potential, BristlePotential):
        return potential
    tables = profile_tables(potential.profile)
    reach = _MARGIN * float(highest) * tables.height
    bristle = bristle_series(potential.bristle, reach, with_rods=True)
    return BristlePotential(tables.planning, bristle)
