"""Where a fit starts: random surfaces inside the bounds."""

import jax
import jax.numpy as jnp
from jaxtyping import Array

from ..._checks import Real
from .barrier import (
    ORDERS,
    FitShape,
    FitTask,
    Unknowns,
    basis,
    heights_of_waves,
    waves_of_heights,
)
from .settings import SETTINGS


def places(layout: FitShape, count: int) -> list[float]:
    """Where starts have their lowest slope, in periods from the highest, on the rows.

    Half a period is best unless the height is bounded: then a surface of several bumps
    can be lower. Where few harmonics are bounded in curvature it is best but for some
    percent: `room_left` looks at other places too.
    """
    known = SETTINGS.places
    wanted = [known[i % len(known)] if layout.high else 0.5 for i in range(count)]
    return [round(place * layout.points) / layout.points for place in wanted]


def random_start(
    layout: FitShape, task: FitTask, key: Array, share: Array, own: Array
) -> Unknowns:
    """A random surface within a third of the bounds, its highest slope at 0.

    `share`, `own`: free parameters wanted and those of the bristles themselves, in shares
    of the bounds; between the two where a bristle would press the other way.
    """
    harmonics = layout.harmonics
    decay = jnp.tile(jnp.arange(1.0, harmonics + 1), 2)
    waves = jax.random.normal(key, (2 * harmonics,)) / decay
    slopes = jnp.asarray(basis(harmonics, layout.points)) @ waves
    waves = _moved(waves, jnp.argmax(slopes) / layout.points)
    free = _pressing(task, share, own)
    known = task.law.at(free)
    widest = jnp.min(jnp.minimum(known.upper, -known.lower)) / task.slope
    allowed = (jnp.minimum(widest, 1.0), task.curvature, 0.5 * task.height)
    sizes = [
        jnp.max(jnp.abs(jnp.asarray(basis(harmonics, layout.points, order)) @ waves))
        for order in ORDERS
    ]
    scale = jnp.min(jnp.stack([a / s for a, s in zip(allowed, sizes, strict=True)]))
    waves = SETTINGS.gentle * scale * waves
    slopes, heights = (
        jnp.asarray(basis(harmonics, layout.points, order)) @ waves for order in (0, -1)
    )
    pad = SETTINGS.pad * (jnp.max(slopes) - jnp.min(slopes))
    spread = jnp.stack([-pad, pad])
    plus, minus = jnp.max(slopes) + spread, -jnp.min(slopes) + spread
    minus = minus.at[0].set(jnp.min(-slopes) - pad)
    reach = SETTINGS.above * jnp.stack([jnp.max(heights), -jnp.min(heights)])
    return Unknowns(waves, plus, minus, reach[: 2 * layout.high], free)


def _moved(waves: Array, shift: Real) -> Array:
    """The surface with this place at 0."""
    cos, sin = heights_of_waves(waves)
    turn = 2 * jnp.pi * jnp.arange(1, cos.size + 1) * shift
    c, s = jnp.cos(turn), jnp.sin(turn)
    return waves_of_heights(cos * c + sin * s, sin * c - cos * s)


def _pressing(task: FitTask, share: Array, own: Array) -> Array:
    """The nearest to `share` on the way from `own` at which bristles press as they do."""
    before = task.law.at(own).alpha
    steps = jnp.linspace(1.0, 0.0, SETTINGS.towards)
    ways = jnp.clip(own[None] + steps[:, None] * (share - own)[None], *SETTINGS.shares)
    good = jax.vmap(lambda free: jnp.all(task.law.at(free).alpha * before > 0))(ways)
    return ways[jnp.argmax(good)]
