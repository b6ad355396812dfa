"""How far a curve is from all solutions of the limit system, exactly."""

import numpy as np
from jaxtyping import Float, Int

_HALVINGS = 60


def distance_from_solutions(
    z: Float[np.ndarray, " n"],
    lower: Float[np.ndarray, " m"],
    upper: Float[np.ndarray, " m"],
    samples: Int[np.ndarray, " n"],
) -> float:
    """The least over all starts of the largest distance at a sample, in m.

    `lower`, `upper`: the strip in m at times between which the load is monotone, `samples`
    the numbers of those at which `z` is known. Over such a stretch a solution is pushed by
    the strip's edges, so it comes from its start s by clips, and clips of clips are clips:
    at each sample it is s, held between two bounds. Within d of the curve it is where these
    bounds let it be, and where s is where they do not hold it.
    """
    least, most = _bounds(lower, upper)
    least, most = least[samples], most[samples]

    def comes_as_near(d: float) -> bool:
        held = np.all(most >= z - d) and np.all(least <= z + d)
        lowest = np.max(z[least < z - d], initial=-np.inf) - d
        highest = np.min(z[most > z + d], initial=np.inf) + d
        return bool(held and lowest <= highest)

    nearest, far = 0.0, float(np.max(np.abs(np.clip(z[0], least, most) - z)))
    if comes_as_near(nearest):
        return nearest
    for _ in range(_HALVINGS):
        middle = (nearest + far) / 2
        if comes_as_near(middle):
            far = middle
        else:
            nearest = middle
    return far


def _bounds(
    lower: Float[np.ndarray, " m"], upper: Float[np.ndarray, " m"]
) -> tuple[Float[np.ndarray, " m"], Float[np.ndarray, " m"]]:
    """Where a solution is at least and at most, at each time, whatever its start."""
    least, most = np.empty_like(lower), np.empty_like(upper)
    low, high = -np.inf, np.inf
    for index, (bottom, top) in enumerate(zip(lower.tolist(), upper.tolist(), strict=True)):
        low, high = min(max(low, bottom), top), min(max(high, bottom), top)
        least[index], most[index] = low, high
    return least, most
