"""Steady slides of traced parts: forces, and all their derivatives in one program."""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from ..._checks import Real
from ..._compile import Program, hoisted, strong_arrays
from ...model import AbstractPotential
from .periodic_orbit import (
    PeriodicOrbit,
    SlideScene,
    force_slopes,
    known_slide_forces,
    least_pull,
    slide_forces,
)
from .slide_sides import Sides, one_side, slide_scene

_SIGNS = np.array([1.0, -1.0])


class AskedSlides(NamedTuple):
    """Slides that differ in `eps` (m), shape (n,); the rest are numbers that all share."""

    potential: AbstractPotential
    gamma: Real
    rate: Real
    stiffness: Real
    eps: Any


def slides_both_ways(
    potential: AbstractPotential,
    gamma: Real,
    rate: Real,
    stiffness: Real,
    eps: Real,
    forces_of: Callable = slide_forces,
) -> tuple[Sides, PeriodicOrbit]:
    """The slides to the right and to the left, (2,), and a period of each; traceable."""

    def one(sign: Real) -> tuple[Sides, PeriodicOrbit]:
        return one_side(potential, eps, gamma, rate, stiffness, sign, forces_of)

    return jax.lax.map(one, jnp.asarray(_SIGNS))


def differentiable_sides(asked: AskedSlides) -> Sides:
    """Mean and peak forces of slides both ways, (n, 2), with first derivatives."""
    return _sides(strong_arrays(hoisted(asked)))


@Program
def _known(asked: AskedSlides) -> tuple[Sides, PeriodicOrbit]:
    def at(eps: Real) -> tuple[Sides, PeriodicOrbit]:
        return slides_both_ways(*asked[:-1], eps, known_slide_forces)

    return jax.lax.map(at, asked.eps)


@Program
def _slopes(asked: AskedSlides, periods: PeriodicOrbit) -> AskedSlides:
    """Derivatives of the two forces by every number, (n, 2, 2, ...)."""
    moving, still = eqx.partition(asked._replace(eps=None), eqx.is_inexact_array)

    def of_side(eps: Real, sign: Real, period: PeriodicOrbit) -> AskedSlides:
        def slide_of(moving: AskedSlides, eps: Real) -> SlideScene:
            potential, gamma, rate, stiffness, _ = eqx.combine(moving, still)
            whole = slide_scene(potential, eps, gamma, rate, stiffness, sign)
            return least_pull(whole)[0]

        slide, back = eqx.filter_vjp(slide_of, moving, eps)
        by_slide = force_slopes(slide, period)
        shared, own = jax.lax.map(back, by_slide)
        return jax.tree_util.tree_map(lambda by: sign * by, shared._replace(eps=own))

    def both_ways(row: tuple) -> AskedSlides:
        eps, periods = row
        sides = jnp.asarray(_SIGNS), periods
        return jax.lax.map(lambda side: of_side(eps, *side), sides)

    return jax.lax.map(both_ways, (asked.eps, periods))


@eqx.filter_custom_jvp
def _sides(asked: AskedSlides) -> Sides:
    return _known(asked)[0]


@_sides.def_jvp
def _along(primals: tuple, tangents: tuple) -> tuple[Sides, Any]:
    """Derivatives by every number come from one program, whatever the direction, which is
    kept as others are: traced for a direction they took 6 s in every process."""
    (asked,), (by,) = primals, tangents
    found, periods = _known(asked)
    slopes = _slopes(asked, periods)
    change = jnp.zeros((*found.mean.shape, 2))
    if by.eps is not None:
        change += slopes.eps * by.eps[:, None, None]
    shared = zip(*(_leaves(tree._replace(eps=None)) for tree in (slopes, by)), strict=True)
    for slope, along in shared:
        if along is not None:
            change += jnp.tensordot(slope, along, axes=jnp.ndim(along))
    none: Any = None
    return found, Sides(change[..., 0], change[..., 1], none, none)


def _leaves(tree: Any) -> list:
    return jax.tree_util.tree_leaves(tree, is_leaf=lambda leaf: leaf is None)
