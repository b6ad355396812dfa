"""Forces along a sampled curve, and what they integrate to between its samples."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from .._checks import Real
from .._compile import Program
from ..numerics import THREE_NODES, THREE_WEIGHTS, concatenated, rows_of
from .forces import AbstractForce, ForceParts
from .settings import SETTINGS

Column = Any
"""An array over samples or intervals: traced inside, NumPy outside."""


class CurveSamples(NamedTuple):
    """At the samples, shapes (n,): the tip y = well + inside in periods, `f` in N with its
    derivatives by z, the load and `V_eps'` in N, dz/dy in m, and how fast the limit would
    slide there, `|l'|/Phi''`, in m/s.
    """

    well: Column
    inside: Column
    force: Column
    slope: Column
    bend: Column
    load: Column
    wiggle: Column
    stretch: Column
    pace: Column


class Intervals(NamedTuple):
    """Between samples, shapes (n-1,): `int f dt` and how far two interpolants differ in
    it, in N s; `f` and `f_z` in the middle; the residual of the balance in J.
    """

    impulse: Column
    doubt: Column
    middle: Column
    middle_slope: Column
    residual: Column


def _sample(force: AbstractForce, t: Real, z: Real) -> CurveSamples:
    well, inside = force.tip(z)

    def along(y: Array) -> tuple[Array, tuple[ForceParts, Array]]:
        driven, slope = force.with_slope(t, well, y)
        return slope, (driven, slope)

    one = jnp.ones_like(inside)
    _, by_tip, (driven, slope) = jax.jvp(along, (inside,), (one,), has_aux=True)
    return CurveSamples(
        well=well,
        inside=inside,
        force=driven.force,
        slope=slope,
        bend=by_tip / driven.stretch,
        load=force.load(t),
        wiggle=driven.wiggle,
        stretch=driven.stretch,
        pace=jnp.abs(force.load.slope(t)) / force.support.stiffness_at(z),
    )


def _hermite(
    s: Column, chord: Column, first: Column, last: Column
) -> tuple[Column, Column]:
    """Rise and slope of the cubic on [0, 1] with the given end slopes, at the share s."""
    a, b = first - chord, last - chord
    rise = s * chord + s * (1 - s) * ((1 - s) * a - s * b)
    return rise, chord + (1 - s) * (1 - 3 * s) * a + s * (3 * s - 2) * b


def _along(force: AbstractForce, viscosity, ends, first, last):
    """Middle, `int f dt` and residual on the cubic with the end slopes given."""
    t0, t1, left, right = ends
    step = t1 - t0
    chord = (right.well - left.well) + (right.inside - left.inside)

    def node(s: Array) -> tuple[Array, Array, Array]:
        rise, speed = _hermite(s, chord, first, last)
        y = left.inside + rise
        found, _, stretch = force.driven(t0 + s * step, left.well, y)
        defect = viscosity * stretch * speed / step - found
        return found, defect**2, y

    found, defect, y = jax.vmap(node)(jnp.asarray(THREE_NODES))
    impulse = step * jnp.sum(THREE_WEIGHTS * found)
    return impulse, step * jnp.sum(THREE_WEIGHTS * defect) / (2 * viscosity), y[1]


def _interval(force: AbstractForce, viscosity: Real, ends) -> Intervals:
    t0, t1, left, right = ends
    step = t1 - t0
    chord = (right.well - left.well) + (right.inside - left.inside)
    stiffness = jnp.maximum(jnp.abs(left.slope), jnp.abs(right.slope))
    stiff = stiffness * step > SETTINGS.stiff * viscosity
    first = step * left.force / (viscosity * left.stretch)
    last = step * right.force / (viscosity * right.stretch)
    bent, bent_residual, y_bent = _along(force, viscosity, ends, first, last)
    flat, flat_residual, y_flat = _along(force, viscosity, ends, chord, chord)
    y = jnp.where(stiff, y_flat, y_bent)
    middle, slope = force.with_slope(0.5 * (t0 + t1), left.well, y)
    # The smallest of three ways to join the samples; a defect shows in all. Velocities at
    # the ends of a rest swing the cubic by up to half a period, and beside a curve that
    # is wrong they cost it a fifth too much; a chord is coarse where the curve bends.
    rest = jnp.where(stiff, _rest_residual(force, viscosity, ends), jnp.inf)
    residual = jnp.minimum(jnp.minimum(bent_residual, flat_residual), rest)
    doubt = jnp.where(stiff, 0.0, 0.25 * jnp.abs(bent - flat))
    return Intervals(jnp.where(stiff, flat, bent), doubt, middle.force, slope, residual)


def _rest_residual(force: AbstractForce, viscosity: Real, ends) -> Real:
    """Residual from the defects at both samples, moving like the equilibrium branch."""
    t0, t1, *samples = ends
    total = 0.0
    for t, at in zip((t0, t1), samples, strict=True):
        branch = -force.load.slope(t) / jnp.where(at.slope == 0, 1.0, at.slope)
        total += (viscosity * branch - at.force) ** 2
    return 0.25 * (t1 - t0) * total / viscosity


@Program
def _chunk(force: AbstractForce, viscosity: Real, ts, z) -> tuple[CurveSamples, Intervals]:
    samples = jax.vmap(lambda t, s: _sample(force, t, s))(ts, z)
    left = jax.tree_util.tree_map(lambda v: v[:-1], samples)
    right = jax.tree_util.tree_map(lambda v: v[1:], samples)
    ends = (ts[:-1], ts[1:], left, right)
    return samples, jax.vmap(lambda e: _interval(force, viscosity, e))(ends)


def every_second(count: int) -> np.ndarray:
    """Numbers of every second sample and of the last, to see what a quadrature is worth."""
    return np.unique(np.append(np.arange(0, count, 2), count - 1))


def along_curve(
    force: AbstractForce, viscosity: float, ts, z
) -> tuple[CurveSamples, Intervals]:
    """Everything at and between the samples, chunk by chunk; NumPy arrays out.

    `viscosity` is `eps^gamma`; ts in s and z in m, shapes (n,), n >= 2.
    """
    traced = jnp.asarray(viscosity)  # a float would compile anew for every gamma
    samples, between = [], []
    for start in range(0, ts.size - 1, SETTINGS.chunk):
        piece = slice(start, start + SETTINGS.chunk + 1)
        count = ts[piece].size
        room = (0, SETTINGS.chunk + 1 - count)
        # The padding goes on in time: an interval of no length would divide by zero.
        later = ts[piece][-1] + (ts[-1] - ts[0]) * np.arange(1, room[1] + 1)
        times = np.concatenate([ts[piece], later])
        at, on = _chunk(force, traced, times, np.pad(z[piece], room, mode="edge"))
        last = start + SETTINGS.chunk >= ts.size - 1
        keep = count if last else count - 1
        samples.append(rows_of(at, slice(keep)))
        between.append(rows_of(on, slice(count - 1)))
    return concatenated(samples), concatenated(between)
