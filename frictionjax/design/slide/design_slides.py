"""Steady slides of many designs in one compiled call."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Int

from ..._checks import as_real, require, require_real
from ...effects import AbstractEffect, LeadingOrder
from ...model import BristlePotential, reaches, with_effects
from ...supports import Spring
from ...wiggly import Status
from .slide_friction import spring_of, where_found
from .slide_rows import find_both_ways, slide_table

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
        told: dict[str, Any] = {"long_name": "how the slides ended", **Status.flags()}
        found["status"] = dims, codes, told
        return found


def slide_numbers(
    eps: Any,
    gamma: Any,
    rate: Any,
    support: Spring | None,
    effects: Sequence[AbstractEffect] = (),
) -> SlideNumbers | None:
    """The numbers, checked; None where there is no eps, and so no slide.

    Raises `ValueError` as `steady_slide` does, for effects but `LeadingOrder`, and for
    numbers of a slide that nobody asks for.
    """
    if eps is None:
        _require_usual(gamma=(gamma, 1.0), rate=(rate, 1.0), support=(support, None))
        return None
    for effect in effects:
        alone = isinstance(effect, LeadingOrder)
        needs = "LeadingOrder alone where eps is given: steady_slide, of one design"
        require(alone, "effects", type(effect).__name__, needs)
    for name, value in (("eps", eps), ("gamma", gamma), ("rate", rate)):
        require_real(name, value, f"{name} > 0", lambda v: v > 0)
    return SlideNumbers(
        eps=float(as_real(eps)),
        gamma=float(as_real(gamma)),
        rate=float(as_real(rate)),
        stiffness=float(spring_of(support).stiffness),
    )


def _require_usual(**given: tuple[Any, Any]) -> None:
    """Of each name a value and the one that it has by itself."""
    for name, (value, usual) in given.items():
        alone = value is usual or (usual is not None and np.array_equal(value, usual))
        require(alone, name, value, "eps beside it: friction in the limit has no slide")


def slides_of_designs(
    designs: Sequence[BristlePotential | None],
    numbers: SlideNumbers,
    effects: Sequence[AbstractEffect] = (),
) -> DesignSlides:
    """The steady slides of all designs, 10 ms of a core each; None: no design, no slide.

    `effects`: those of their scene that `slide_numbers` takes.
    """
    count, (eps, *others) = len(designs), numbers
    forces = {name: np.full(count, np.nan) for name in MEANINGS}
    status = np.full(count, int(Status.NOT_TRIED))
    wiggles = {n: with_effects(one, effects) for n, one in enumerate(designs) if one}
    known = [n for n, wiggle in wiggles.items() if reaches(wiggle, np.array([eps]))[0]]
    if not known:
        return DesignSlides(forces, status)
    tables = [slide_table(wiggles[n], eps) for n in known]
    places, sizes = np.arange(len(known)), np.full(len(known), eps)
    sides = where_found(find_both_ways(tables, places, sizes, *others), np)
    status[known] = sides.code.max(axis=1)
    for name in MEANINGS:
        force, side = name.split("_")
        forces[name][known] = getattr(sides, force)[:, 0 if side == "plus" else 1]
    return DesignSlides(forces, status)
