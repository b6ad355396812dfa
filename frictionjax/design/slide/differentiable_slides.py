"""Steady slides of traced parts: forces, and all their derivatives in one program."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array

from ..._checks import Real
from ..._compile import Program, strong_arrays
from ...model import AbstractPotential
from .slide_sides import Sides, one_side


class AskedSlides(NamedTuple):
    """Slides that differ in `eps` (m), shape (n,); the rest are numbers that all share."""

    potential: AbstractPotential
    gamma: Real
    rate: Real
    stiffness: Real
    eps: Any


def slides_both_ways(
    potential: AbstractPotential, gamma: Real, rate: Real, stiffness: Real, eps: Real
) -> Sides:
    """The slides to the right and to the left, (2,); traceable."""

    def one(sign: Real) -> Sides:
        return one_side(potential, eps, gamma, rate, stiffness, sign)

    return jax.vmap(one)(jnp.array([1.0, -1.0]))


def differentiable_sides(asked: AskedSlides) -> Sides:
    """Mean and peak forces of slides both ways, (n, 2), with first derivatives."""
    return _sides(strong_arrays(asked))


@Program
def _known(asked: AskedSlides) -> Sides:
    return jax.vmap(lambda eps: slides_both_ways(*asked[:-1], eps))(asked.eps)


@Program
def _with_slopes(asked: AskedSlides) -> tuple[Sides, AskedSlides]:
    """Slides, and derivatives of their two forces by every number, (n, 2, 2, ...)."""
    moving, still = eqx.partition(asked._replace(eps=None), eqx.is_inexact_array)

    def forces(moving: AskedSlides, eps: Real, sign: Real) -> tuple[Array, Sides]:
        potential, gamma, rate, stiffness, _ = eqx.combine(moving, still)
        found = one_side(potential, eps, gamma, rate, stiffness, sign)
        return jnp.stack([found.mean, found.peak]), found

    def slopes(eps: Real, sign: Real) -> tuple[Sides, AskedSlides]:
        by, found = jax.jacrev(forces, (0, 1), has_aux=True)(moving, eps, sign)
        return found, by[0]._replace(eps=by[1])

    both_ways = jax.vmap(slopes, (None, 0))
    return jax.vmap(lambda eps: both_ways(eps, jnp.array([1.0, -1.0])))(asked.eps)


@eqx.filter_custom_jvp
def _sides(asked: AskedSlides) -> Sides:
    return _known(asked)


@_sides.def_jvp
def _along(primals: tuple, tangents: tuple) -> tuple[Sides, Any]:
    """Derivatives by every number come from one program, whatever the direction, which is
    kept as others are: traced for a direction they took 6 s in every process."""
    (asked,), (by,) = primals, tangents
    found, slopes = _with_slopes(asked)
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
