"""Wiggly potentials of tables: what programs are compiled for, once a size."""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from .._checks import ByIdentity, Real, is_concrete
from ..bristles import Homothetic
from ..profiles import AbstractProfile
from ..tables import bristle_at_rest, bristle_series, profile_tables
from .potentials import AbstractPotential, BristlePotential, GivenPotential, no_rest
from .summed_potential import SummedPotential
from .summed_series import leaves_nothing, surface_of_sum

_MARGIN = 1.01  # heights beyond those of the samples


class _Height(AbstractProfile):
    """W of a given potential, as the height of a surface."""

    W_fn: Callable[[Real], Real]
    points: int = eqx.field(static=True, default=4096)

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        y = jnp.asarray(y)
        return jnp.asarray(self.W_fn(y - jnp.floor(y)))


_BARE = ByIdentity()  # of given potentials: their W alone


def _bare(given: GivenPotential) -> AbstractPotential:
    """`eps W`, of a tip that its height moves nowhere; itself where no table holds W."""
    known = _BARE.get(given)
    if known is None:
        height = _Height(given.W_fn, given.points)
        known = BristlePotential(height, Homothetic(jnp.asarray(1.0)))
        _BARE.put(given, known)
    return known if profile_tables(known.profile).is_table else given


def potential_at_rest(potential: AbstractPotential) -> AbstractPotential:
    """A known potential as its coefficients see it, eps -> 0; itself without a table."""
    if not is_concrete(potential):
        return potential
    if isinstance(potential, SummedPotential):
        one = surface_of_sum(potential, potential_at_rest(potential.single), 0.0)
        return potential_at_rest(one)
    if isinstance(potential, GivenPotential):
        potential = _bare(potential)
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
    elif isinstance(potential, GivenPotential) and potential.Q_fn is no_rest:
        potential = _bare(potential)
    if not isinstance(potential, BristlePotential):
        return potential, potential
    tables = profile_tables(potential.profile)
    bristle = bristle_series(potential.bristle, _MARGIN * highest * tables.height)
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
