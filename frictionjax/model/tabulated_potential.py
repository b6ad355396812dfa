"""Wiggly potentials of tables: what programs are compiled for, once a size."""

from typing import Any

from .._checks import is_concrete
from ..tables import bristle_at_rest, bristle_series, profile_tables
from .potentials import AbstractPotential, BristlePotential
from .summed_potential import SummedPotential
from .summed_series import leaves_nothing, surface_of_sum

_MARGIN = 1.01  # heights beyond those of the samples


def potential_at_rest(potential: AbstractPotential) -> AbstractPotential:
    """A known potential as its coefficients see it, eps -> 0; itself where it is given."""
    if not is_concrete(potential):
        return potential
    if isinstance(potential, SummedPotential):
        one = surface_of_sum(potential, potential_at_rest(potential.single), 0.0)
        return potential_at_rest(one)
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

    Itself where it is given. A sum of several tips' is that at `highest`, and at no other
    eps.
    """
    if isinstance(potential, SummedPotential):
        single, _ = tabulated_potentials(potential.single, highest)
        potential = surface_of_sum(potential, single, highest)
    if not isinstance(potential, BristlePotential):
        return potential, potential
    tables = profile_tables(potential.profile)
    bristle = bristle_series(potential.bristle, _MARGIN * highest * tables.height)
    return BristlePotential(tables.planning, bristle), BristlePotential(
        tables.lanes, bristle
    )


def potential_in_reach(potential: AbstractPotential, highest: Any) -> AbstractPotential:
    """As planning evaluates it, and with the rod that it is, where it is one."""
    if not isinstance(potential, BristlePotential):
        return potential
    tables = profile_tables(potential.profile)
    reach = _MARGIN * float(highest) * tables.height
    bristle = bristle_series(potential.bristle, reach, with_rods=True)
    return BristlePotential(tables.planning, bristle)
