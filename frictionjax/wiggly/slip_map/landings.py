"""How soon after a fold the tip is half a well further, on a slow slide."""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..._checks import Real
from ..._compile import in_chunks, once_a_scene
from .contraction import GRID, Wells
from .settings import SETTINGS

_FIRST = np.arange(0, GRID.size - 1, SETTINGS.thin)  # of each stretch of the grid


@once_a_scene
def _landed(
    gaps: Float[Array, "slides stretches"],
    ends: Float[Array, "slides stretches"],
    ways: Float[Array, "slides stretches"],
    drag: Float[Array, " slides"],
    softest: Float[Array, " slides"],
    stiffest: Float[Array, " slides"],
) -> tuple[Float[Array, " slides"]]:
    """When tips have passed the last stretch, at the latest, in wells of the path."""

    start = jnp.asarray(SETTINGS.latest - 1.0)

    def one(gaps, ends, ways, drag, softest, stiffest):
        def through(time: Real, stretch: tuple) -> tuple[Real, None]:
            gap, end, way = stretch
            # The least force in it: where the tip has come to its end.
            held = jnp.where(time < end, stiffest, softest) * (time - end) + gap
            # It waits on its branch until the path has gone on.
            time += jnp.maximum(-held, 0.0) / stiffest
            force, needed = jnp.maximum(held, 0.0), drag * way
            root = jnp.sqrt(force**2 + 2 * softest * needed)
            # Nothing drags where nothing slides.
            return time + 2 * needed / jnp.maximum(force + root, 1e-300), None

        return jax.lax.scan(through, start, (gaps, ends, ways))[0]

    return (jax.vmap(one)(gaps, ends, ways, drag, softest, stiffest),)


def latest_landings(
    wells: Wells, lag: np.ndarray, drag: np.ndarray, softest, stiffest
) -> np.ndarray:
    """Wells from a fold on which tips are half a well beyond it, at most; (2, cells).

    A bound from above for slides that have come a few wells without a rest, in which tips
    fall back and the path does not: the path goes `s` wells beyond the fold at its largest
    speed on slides, and the tip, in z, `Z` wells: `dZ/ds` is the force
    `k (s - Z) + gap(Z)` over the `drag` (N, (cells,)). From half a well before the fold,
    where it is that late after the last one, through stretches in which the force is no
    less than at their ends, nor than at the second highest fold, which they may step over.
    `softest`, `stiffest`: the least and the largest `k` that a well is pulled back by, in
    N, (cells,). Infinite beyond `SETTINGS.latest`, where slides are not slow: all are that
    lag as much (`lag`: in wells, (2, cells)), as a smaller force lets none pass in time.
    """
    near = lag < SETTINGS.latest
    if not near.any():
        return np.full(lag.shape, np.inf)
    count = drag.size
    # To the left tips come from the grid's other end.
    gaps, stretch = (
        np.concatenate([each[:count], each[count:, ::-1]])
        for each in (wells.gaps, wells.stretch)
    )
    ways = 0.5 * (stretch[:, 1:] + stretch[:, :-1]) * np.diff(GRID)
    ways = np.add.reduceat(ways, _FIRST, axis=1)
    ends = np.cumsum(ways, axis=1)
    ends -= ends[:, [ends.shape[1] // 2 - 1]]
    least = np.minimum(gaps[:, _FIRST + SETTINGS.thin], wells.second[:, None])
    least = np.minimum(np.minimum.reduceat(gaps[:, :-1], _FIRST, axis=1), least)
    forces = (np.tile(each, 2) for each in (drag, softest, stiffest))
    (found,) = in_chunks(_landed, SETTINGS.landings, (), (least, ends, ways, *forces))
    found = found.reshape(lag.shape)
    return np.where(near & (found <= SETTINGS.latest), found, np.inf)
