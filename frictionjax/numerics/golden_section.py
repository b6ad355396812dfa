"""Places that fill a stretch evenly, however many, and are multiples of nothing."""

import numpy as np
from jaxtyping import Float

_GOLDEN = 0.5 * (5**0.5 - 1)


def even_places(count: int) -> Float[np.ndarray, " count"]:
    """So many places in [0, 1), each a golden section from the last."""
    return np.mod(_GOLDEN * np.arange(count), 1.0)
