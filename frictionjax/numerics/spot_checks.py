"""How one function is held against another: at many places, by the largest value."""

import numpy as np
from jaxtyping import ArrayLike, Float

_GOLDEN = 0.5 * (5**0.5 - 1)


def even_places(count: int) -> Float[np.ndarray, " count"]:
    """So many places in [0, 1), each a golden section from the last.

    They fill it evenly, however many, and are multiples of nothing.
    """
    return np.mod(_GOLDEN * np.arange(count), 1.0)


def are_near(
    one: Float[ArrayLike, "*shape"], other: Float[ArrayLike, "*shape"], share: float
) -> bool:
    """Whether values differ by no more than a share of the largest of `one`."""
    one, other = np.asarray(one), np.asarray(other)
    return bool(np.max(np.abs(one - other)) <= share * np.max(np.abs(one)))
