"""Steady slides of many designs in one compiled call."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..._checks import as_real, require_real
from ..._compile import Program, padded_size
from ...model import BristlePotential, tabulated_potentials
from ...supports import Spring
from ...tables import SeriesBristle, SeriesProfile, with_harmonics, with_terms
from ...wiggly import FLAGS, Status
from .periodic_orbit import SlideScene, survey_ground
from .settings import SETTINGS
from .slide_friction import slide_at, spring_of

MEANINGS = {
    "mean_plus": "mean force of a steady slide to the right",
    "mean_minus": "mean force of a steady slide to the left",
    "peak_plus": "largest force of a steady slide to the right",
    "peak_minus": "largest force of a steady slide to the left",
}


class SlideNumbers(NamedTuple):
    """What steady slides are asked for: `eps` in m, `rate` in N/s, `stiffness` in N/m."""

    eps: float
    gamma: float
    rate: float
    stiffness: float

    def attributes(self) -> dict[str, float]:
        """For a data set, by name."""
        return self._asdict()


class DesignSlides(NamedTuple):
    """Forces (N) by name, NaN where there is no slide, and a `Status` for each design.

    `NOT_TRIED`: no design, or one whose bristle loses its contact at this eps.
    """

    forces: dict[str, Float[np.ndarray, " n"]]
    status: Int[np.ndarray, " n"]

    def columns(self, dims: tuple[str, ...], shape: tuple[int, ...]) -> dict[str, tuple]:
        """For a data set, with units and meanings."""
        found: dict[str, tuple] = {}
        for name, values in self.forces.items():
            attributes = {"units": "N", "long_name": MEANINGS[name]}
            found[name] = dims, values.reshape(shape), attributes
        codes = self.status.astype(np.int8).reshape(shape)
        told: dict[str, Any] = {"long_name": "how the slides ended", **FLAGS}
        found["status"] = dims, codes, told
        return found


def slide_numbers(eps: Any, gamma: Any, rate: Any, support: Spring | None) -> SlideNumbers:
    """The numbers, checked; raises `ValueError` as `steady_slide` does."""
    for name, value in (("eps", eps), ("gamma", gamma), ("rate", rate)):
        require_real(name, value, f"{name} > 0", lambda v: v > 0)
    return SlideNumbers(
        eps=float(as_real(eps)),
        gamma=float(as_real(gamma)),
        rate=float(as_real(rate)),
        stiffness=float(spring_of(support).stiffness),
    )


def slides_of_designs(
    designs: Sequence[BristlePotential | None], numbers: SlideNumbers
) -> DesignSlides:
    """The steady slides of all designs, about 20 ms each; None: no design, no slide."""
    count = len(designs)
    forces = {name: np.full(count, np.nan) for name in MEANINGS}
    status = np.full(count, int(Status.NOT_TRIED))
    known = [place for place, design in enumerate(designs) if design is not None]
    groups: dict[Any, list[tuple[int, Any]]] = {}
    for place, table in zip(
        known, _alike([designs[i] for i in known], numbers), strict=True
    ):
        leaves, structure = jax.tree_util.tree_flatten(table)
        shapes = tuple(np.shape(leaf) for leaf in leaves)
        groups.setdefault((structure, shapes), []).append((place, leaves))
    for (structure, _), members in groups.items():
        size = min(padded_size(len(members), SETTINGS.lanes, 4), SETTINGS.designs_at_once)
        for at in range(0, len(members), size):
            some = members[at : at + size]
            filled = [leaves for _, leaves in some] + [some[-1][1]] * (size - len(some))
            columns = [np.stack(rows) for rows in zip(*filled, strict=True)]
            tables = jax.tree_util.tree_unflatten(structure, columns)
            found, least = _slides(tables, *(np.asarray(v) for v in numbers))
            places = np.array([place for place, _ in some])
            follows = np.asarray(least)[: len(some)] > 0
            kept = places[follows]
            for name in MEANINGS:
                forces[name][kept] = np.asarray(getattr(found, name))[: len(some)][follows]
            codes = np.maximum(np.asarray(found.code_plus), np.asarray(found.code_minus))
            status[kept] = codes[: len(some)][follows]
    return DesignSlides(forces, status)


def _alike(designs: Sequence[Any], numbers: SlideNumbers) -> list[BristlePotential]:
    """Tables of designs, series as long as the longest: one program for all of them.

    (A program for each size of series took 116 s for a map of 15 designs, 20 s each.)
    """
    tables: list[Any] = [tabulated_potentials(d, numbers.eps)[1] for d in designs]
    waves = [t.profile.cos.size for t in tables if isinstance(t.profile, SeriesProfile)]
    terms = [t.bristle.ahead.size for t in tables if isinstance(t.bristle, SeriesBristle)]
    return [
        BristlePotential(
            with_harmonics(table.profile, max(waves, default=1)),
            with_terms(table.bristle, max(terms, default=1)),
        )
        for table in tables
    ]


@Program
def _slides(
    designs: BristlePotential, eps: Array, gamma: Array, rate: Array, stiffness: Array
) -> Any:
    """The slide of each design, and its smallest G."""

    def one(design: BristlePotential) -> Any:
        scene = SlideScene(
            design, eps, jnp.ones(()), rate * eps ** (gamma + 1), stiffness * eps
        )
        return slide_at(design, eps, gamma, rate, stiffness), survey_ground(scene)[2]

    return jax.vmap(one)(designs)
