"""A force in tables, whose programs are there, where its parts say the same."""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..._compile import Interpreted, in_chunks, values_at
from ...model import tabulated_potentials
from ...numerics import are_near, even_places
from ...tables import load_table
from .force import AbstractForce, Force
from .settings import SETTINGS


def force_in_tables(force: Force, ts: Float[np.ndarray, " n"]) -> Force:
    """The force in tables, so that no scene compiles anything; else itself.

    A certificate takes nobody's word: parts are asked themselves, uncompiled, at places all
    over the period and at the times `ts` in s. Where a table says anything else than they
    do it is not used.
    """
    potential, _ = tabulated_potentials(force.potential, float(force.eps))
    load = load_table(force.load)
    if potential is force.potential and load is force.load:
        return force
    tables = Force(potential=potential, support=force.support, load=load, eps=force.eps)
    return tables if _say_the_same(force, tables, ts) else force


@Interpreted
def _at_places(force: AbstractForce, y: Array) -> tuple[Array, Array, Array]:
    """`V'` in N, dz/dp and z/eps of tips at y in the well 0, (n,)."""
    pull, stretch = jax.vmap(force.pull)(y)
    return pull, stretch, jax.vmap(force.state)(jnp.zeros_like(y), y) / force.eps


def _say_the_same(force: Force, tables: Force, ts: np.ndarray) -> bool:
    y = even_places(SETTINGS.places)
    of_places = zip(_at_places(force, y), _at_places(tables, y), strict=True)
    of_times = [
        in_chunks(values_at, SETTINGS.chunk, (load,), (ts,))
        for load in (force.load, tables.load)
    ]
    pairs = (*of_places, of_times)
    return all(are_near(one, other, SETTINGS.same) for one, other in pairs)
