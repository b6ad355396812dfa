"""Arrays lengthened to few different sizes, so that programs are compiled few times."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array


def room(count: int, least: int, factor: int = 4) -> int:
    """The smallest of least, factor least, factor^2 least ... that holds `count`."""
    size = least
    while size < count:
        size *= factor
    return size


def fitted(least: int, *columns: np.ndarray) -> list[Array]:
    """Columns lengthened by their last entry to a size from `room`."""
    size = room(columns[0].size, least)
    return [jnp.asarray(np.pad(c, (0, size - c.size), mode="edge")) for c in columns]
