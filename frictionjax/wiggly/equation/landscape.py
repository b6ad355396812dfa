"""What step control needs to know of the wiggly force, from a scan of one period."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from ..._checks import Real
from ...model import AbstractPotential
from ...numerics import periodic_extrema, slope_of
from .settings import SETTINGS


class WiggleFolds(NamedTuple):
    """Extreme folds in the tip coordinate of well 0, where slides hang before a slip.

    `place_*`: periods, `state_*`: z in m, `force_*`: V_eps' in N, at its maximum (plus)
    and minimum (minus). `bend_*`: half its curvature there, N; `stretch_*`: G.
    """

    place_plus: Real
    state_plus: Real
    force_plus: Real
    place_minus: Real
    state_minus: Real
    force_minus: Real
    bend_plus: Real
    bend_minus: Real
    stretch_plus: Real
    stretch_minus: Real


class Landscape(eqx.Module):
    """What step control needs to know of the wiggly force in the tip coordinate.

    `fold_curvature`, `flat_curvature`: |W'''| at the sharper and at the flatter of the two
    extreme folds, in N. `steepest`: max |W''| in N. `branch`: width in periods of the
    narrowest branch on which `W'` is monotone, corners left out; a tip must cross a falling
    one to change wells. `stretch`: largest G.
    """

    fold_curvature: Real
    flat_curvature: Real
    steepest: Real
    branch: Real
    stretch: Real
    folds: WiggleFolds


def landscape(potential: AbstractPotential, eps: Real) -> Landscape:
    """Scan one period of `V_eps'` in the tip coordinate."""
    points = potential.points

    def force(y: Real) -> Real:
        return potential.tip_force(y, eps)[0]

    # Nobody differentiates a plan: a tenth less to trace.
    extrema = periodic_extrema(force, points, differentiable=False)
    grid = (jnp.arange(points) + 0.5) / points
    one = jnp.ones_like(grid)
    every = jax.vmap(lambda y: potential.tip_force(y, eps))
    (_, stretches), (slopes, _) = jax.jvp(every, (grid,), (one,))
    top, bottom = extrema.argmax, extrema.argmin
    ends = jnp.stack([top, bottom])
    states = eps * ends + jax.vmap(lambda y: potential.offset(y, eps))(ends)
    _, stretch = every(ends)
    # Forward twice: reverse mode takes twice as long to trace.
    curvatures = jnp.abs(slope_of(slope_of(jax.vmap(force)))(ends))
    folds = WiggleFolds(
        place_plus=top,
        state_plus=states[0],
        force_plus=extrema.max,
        place_minus=bottom,
        state_minus=states[1],
        force_minus=extrema.min,
        bend_plus=0.5 * curvatures[0],
        bend_minus=0.5 * curvatures[1],
        stretch_plus=stretch[0],
        stretch_minus=stretch[1],
    )
    return Landscape(
        fold_curvature=jnp.max(curvatures),
        flat_curvature=jnp.min(curvatures),
        steepest=jnp.max(jnp.abs(slopes)),
        branch=jnp.minimum(_narrowest_run(slopes) / points, 0.5),
        stretch=jnp.max(stretches),
        folds=folds,
    )


def _narrowest_run(slopes: Float[Array, " n"]) -> Int[Array, ""]:
    """Samples in the shortest run of one sign of the 1-periodic `slopes`, at least 2.

    Rounding noise on flat stretches counts as rising. A run far narrower than those on both
    its sides is a corner, which a step that goes over it sees from beyond.
    """
    falling: Bool[Array, " more"] = slopes < -1e-9 * jnp.max(jnp.abs(slopes))
    falling = jnp.tile(falling, 3)  # so that of each run one has both its neighbours
    index, count = jnp.arange(falling.shape[0]), falling.shape[0]
    turns = (falling != jnp.roll(falling, 1)) & (index > 0)
    # Sorted to the front (a running maximum instead compiles three times as long).
    places = jnp.sort(jnp.where(turns, index, 2 * count))
    widths = jnp.where(places[1:] < count, jnp.diff(places), 0)
    before, own, after = widths[:-2], widths[1:-1], widths[2:]
    corner = SETTINGS.corner * own < jnp.minimum(before, after)
    counts = (before > 0) & (own > 0) & (after > 0) & ~corner
    return jnp.maximum(jnp.min(jnp.where(counts, own, count)), 2)
