"""Loads of all classes, times at which they are asked, and the kind of a table."""

import equinox as eqx
import jax
import numpy as np

import frictionjax as fx

L = fx.loads
T = np.concatenate([np.linspace(0, 3, 301), [0.5, 1.5, 2.5]])
LOADS = {
    "ramp": L.Ramp(2.0, -0.5),
    "sine": L.Sine(1.3, 2.0),
    "triangle": L.Triangle(1.3, 2.0),
    "points": L.PiecewiseLinear([0.2, 0.9, 2.1], [0.0, 1.0, -1.0]),
    "one point": L.PiecewiseLinear([0.2], [0.7]),
    "many points": L.PiecewiseLinear(np.linspace(0, 3, 50), np.sin(np.arange(50))),
}


def with_slopes(load, times):
    """Values and slopes, (2, n), by one program for all loads of a kind."""
    return np.array(_with_slopes(load, times))


@eqx.filter_jit
def _with_slopes(load, times):
    return jax.vmap(lambda t: (load(t), load.slope(t)))(times)


def shapes(table):
    return type(table), *(np.shape(leaf) for leaf in jax.tree_util.tree_leaves(table))
