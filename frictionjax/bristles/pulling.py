"""Bristles that pull on the surface, alpha < 0: the paper allows them, few exist."""

from typing import Any

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Array

from .._checks import as_text, is_concrete
from .._compile import Interpreted
from .bristle import AbstractBristle
from .slanted_spring import SlantedSpring
from .vertical_spring import VerticalSpring

PULLS = "the bristle pulls on the surface"


def pulling_text(alpha: Any, bristle: AbstractBristle | None = None) -> str:
    """What to say of a normal force in N: nothing unless it is below 0.

    Of a batch, how many are. With the bristle, whether its rest length and its height look
    swapped.
    """
    below = np.asarray(alpha) < 0
    if not below.any():
        return ""
    if below.ndim:
        return f"alpha < 0 in {np.sum(below)} of {below.size}: {PULLS}"
    parts = [f"alpha = {as_text(alpha)} N < 0: {PULLS}", swapped_text(bristle)]
    return "; ".join(part for part in parts if part)


def pulling_note(bristle: AbstractBristle | None) -> str:
    """`pulling_text` of a bristle alone."""
    if bristle is None or not is_concrete(bristle):
        return ""
    return pulling_text(normal_force(bristle), bristle)


def swapped_text(bristle: AbstractBristle | None) -> str:
    """Says so where a spring pulls that would press with its two lengths exchanged."""
    if not isinstance(bristle, VerticalSpring | SlantedSpring) or not is_concrete(bristle):
        return ""
    rest, height = bristle.rest_length, bristle.height
    if np.ndim(rest) or np.ndim(height):  # a batch
        return ""
    other = eqx.tree_at(lambda b: (b.rest_length, b.height), bristle, (height, rest))
    if not normal_force(bristle) < 0 < normal_force(other):
        return ""
    return f"rest_length = {as_text(rest)} and height = {as_text(height)} look swapped"


def normal_force(bristle: AbstractBristle) -> float:
    """alpha = F'(0) in N, of known numbers."""
    return float(_slope_of_energy(bristle, np.float64(0.0)))


@Interpreted
def _slope_of_energy(bristle: AbstractBristle, eta: Array) -> Array:
    return jax.grad(bristle.energy)(eta)
