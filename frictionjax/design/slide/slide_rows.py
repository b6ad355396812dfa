"""Slides of known parts: rows of one compiled program, whatever the parts are."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..._compile import ARRAYS, Program, side_by_side
from ...model import AbstractPotential, BristlePotential, tabulated_potentials
from ...tables import SeriesBristle, SeriesProfile, Waves
from .periodic_orbit import known_slide_forces
from .settings import SETTINGS
from .slide_sides import Sides, one_side


class SlideRows(NamedTuple):
    """Slides that are asked for, shape (n,) each: `eps` in m, `rate` in N/s, `stiffness` in
    N/m, `sign` 1 to the right and -1 to the left; `table`: which of some potentials."""

    table: Int[np.ndarray, " n"]
    eps: Float[np.ndarray, " n"]
    gamma: Float[np.ndarray, " n"]
    rate: Float[np.ndarray, " n"]
    stiffness: Float[np.ndarray, " n"]
    sign: Float[np.ndarray, " n"]


def rows_of_slides(
    table: Any, eps: Any, gamma: Any, rate: Any, stiffness: Any, sign: Any
) -> SlideRows:
    """Rows of numbers and arrays that broadcast to one axis."""
    columns = np.broadcast_arrays(table, eps, gamma, rate, stiffness, sign)
    return SlideRows(np.array(columns[0]), *(np.array(c, float) for c in columns[1:]))


def slide_table(potential: AbstractPotential, highest: float) -> AbstractPotential:
    """A known potential for eps up to `highest` (m), in one of a few sizes.

    Of an array's sum: at that eps. A size takes 4 s to trace and compile, and so does every
    kind of parts as they are. (With 8 harmonics written out: 8 s, and a slide a quarter
    longer.)
    """
    _, table = tabulated_potentials(potential, highest)
    if not isinstance(table, BristlePotential):
        return table
    profile, bristle = table.profile, table.bristle
    if isinstance(profile, SeriesProfile):
        waves = (_filled(c, SETTINGS.harmonics) for c in (profile.cos, profile.sin))
        profile = Waves(profile.mean, *waves)
    if isinstance(bristle, SeriesBristle):
        ahead, climb = (_filled(c, SETTINGS.terms) for c in (bristle.ahead, bristle.climb))
        bristle = SeriesBristle(ahead, climb, bristle.per_height)
    return BristlePotential(profile, bristle)


def _filled(terms: Any, sizes: tuple[int, ...]) -> Float[Array, " size"]:
    """Terms of a series, in the smallest size that holds them: the further ones are 0."""
    count = terms.shape[0]
    size = min((n for n in sizes if n >= count), default=count)
    return jnp.pad(terms, (0, size - count))


def find_slides(tables: Sequence[AbstractPotential], rows: SlideRows) -> Sides:
    """The slide of each row, about 4 ms of a core each, on all cores that work here."""
    found = np.full((len(Sides._fields), rows.eps.size), np.nan)

    def find(some: list[int]) -> list[np.ndarray]:
        filled = some + some[-1:] * (SETTINGS.rows - len(some))
        numbers = [column[filled] for column in rows[1:]]
        part = _sides(_stacked([tables[i] for i in rows.table[filled]]), *numbers)
        return [np.asarray(column)[: len(some)] for column in part]

    calls = _calls([_kind(tables[which]) for which in rows.table])
    for some, part in zip(calls, side_by_side("slides", find, calls), strict=True):
        found[:, some] = part
    return Sides(*found)


def _calls(kinds: Sequence[tuple]) -> list[list[int]]:
    """Rows that go together in a call, by their kinds."""
    alike: dict[Any, list[int]] = {}
    for row, kind in enumerate(kinds):
        alike.setdefault(kind, []).append(row)
    size = SETTINGS.rows
    return [of[at : at + size] for of in alike.values() for at in range(0, len(of), size)]


def find_both_ways(
    tables: Sequence[AbstractPotential],
    table: Int[np.ndarray, " n"],
    eps: Float[np.ndarray, " n"],
    gamma: float,
    rate: float,
    stiffness: float,
) -> Sides:
    """To the right and to the left, arrays (n, 2); arguments as in `SlideRows`."""
    which, both = np.repeat(table, 2), np.repeat(eps, 2)
    signs = np.tile([1.0, -1.0], eps.size)
    rows = rows_of_slides(which, both, gamma, rate, stiffness, signs)
    return Sides(*(column.reshape(-1, 2) for column in find_slides(tables, rows)))


def _kind(table: AbstractPotential) -> tuple:
    leaves, structure = jax.tree_util.tree_flatten(table)
    return structure, *(np.shape(x) if isinstance(x, ARRAYS) else x for x in leaves)


def _stacked(tables: Sequence[AbstractPotential]) -> AbstractPotential:
    """One potential whose arrays have a row for each; functions are those of the first."""

    def column(*leaves: Any) -> Any:
        return np.stack(leaves) if isinstance(leaves[0], ARRAYS) else leaves[0]

    return jax.tree_util.tree_map(column, *tables)


@Program
def _sides(
    potentials: AbstractPotential,
    eps: Array,
    gamma: Array,
    rate: Array,
    stiffness: Array,
    sign: Array,
) -> tuple:
    arrays, rest = eqx.partition(potentials, eqx.is_array)

    def one(row: tuple) -> tuple:
        own, eps, gamma, rate, stiffness, sign = row
        numbers = eqx.combine(own, rest), eps, gamma, rate, stiffness, sign
        sides, _ = one_side(*numbers, known_slide_forces)
        return tuple(sides)

    # One after the other: side by side they took 9 s to trace and compile for 4.5, and no
    # less time each, as all wait for the slowest.
    return jax.lax.map(one, (arrays, eps, gamma, rate, stiffness, sign))
