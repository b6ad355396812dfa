"""Functions of one number at many places, each by one program.

Step by step is a program for each step, 0.03 s of a core each.
"""

import equinox as eqx
import jax
import numpy as np


def at_places(fn, places):
    """Values, (n,)."""
    return np.asarray(part_at(fn, np.asarray(places)))


def each_at_places(fns, places):
    """Values of several functions, (functions, n), by one program."""
    return np.array(jax.jit(jax.vmap(lambda place: [fn(place) for fn in fns]))(places))


@eqx.filter_jit
def part_at(part, places):
    """Values of a part, (n,): parts of one kind share a program."""
    return jax.vmap(part)(places)


def with_derivatives(fn, places):
    """Values, slopes and second derivatives, (3, n)."""
    return np.array(_derivatives(fn, np.asarray(places)))


@eqx.filter_jit
def _derivatives(fn, places):
    slope = jax.grad(fn)
    orders = fn, slope, jax.grad(slope)
    return jax.vmap(lambda place: [order(place) for order in orders])(places)


def relative_errors(fn, other, places):
    """Of the other's values and derivatives, (3,), by their sizes."""
    expected, found = with_derivatives(fn, places), with_derivatives(other, places)
    return np.abs(found - expected).max(axis=1) / np.abs(expected).max(axis=1)
