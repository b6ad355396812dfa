"""Passages of one well under steady pulls, at folds with a curvature and at flat ones."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from flat_folds import SCENES, SLANTED, scene_of

import frictionjax as fx
from frictionjax.wiggly.equation.landscape import landscape
from frictionjax.wiggly.slip_map.transit import steady_transit_times
from frictionjax.wiggly.slip_map.well_pull import WellArc, well_pull_of

EPS, SMALLEST = 1e-5, 1e-6
EVERY = {**SCENES, "sine": scene_of(fx.profiles.Sine(0.12), SLANTED)}


@eqx.filter_jit
def tip_forces(potential, places):
    return potential.tip_force(places, EPS)


def plain_passage(potential, folds, beyond):
    """`int_0^1 eps G dy/(beyond + fold - V_eps')` by a fine sum."""
    # Graded towards the fold: straight lines in its logarithm on either side.
    edges = np.concatenate([[0.0], np.geomspace(1e-9, 0.5, 2000)])
    nodes, weights = np.polynomial.legendre.leggauss(6)
    width = np.diff(edges)[:, None]
    half = (edges[:-1, None] + 0.5 * width * (nodes + 1)).ravel()
    weight = (0.5 * width * weights).ravel()
    total = 0.0
    for side in (1, -1):
        places = float(folds.place_plus) + side * half
        force, stretch = tip_forces(potential, places)
        gaps = float(folds.force_plus) - np.asarray(force)
        total += np.sum(weight * EPS * np.asarray(stretch) / (beyond + gaps))
    return total


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=[pytest.mark.slow] if n == "sawtooth" else []) for n in EVERY],
)
def test_passages_are_resolved_under_every_pull(name):
    potential, one = EVERY[name].potential, np.ones(1)
    folds = jax.jit(landscape)(potential, jnp.asarray(EPS)).folds
    place, force = float(folds.place_plus) * one, float(folds.force_plus) * one
    track = well_pull_of(
        potential, WellArc(EPS * one, place, one, one, force, SMALLEST * one)
    )
    for times in (1.0, 30.0, 1e3, 1e5):
        beyond = SMALLEST * times
        found = steady_transit_times(track, one, beyond + force[:, None] - track.fold)
        plain = plain_passage(potential, folds, beyond)
        assert abs(found[0, 0] / plain - 1) < 1e-7, times
