"""Places beside other maxima of the force of a well, where it is tabulated too coarsely."""

import numpy as np

from .settings import SETTINGS


def with_second_tops(place: np.ndarray, held: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """`place` (n,), in periods and rising, and `held` (n,), with those beside other maxima.

    The table is dense around the largest one only. Tips rest at the others too, at a second
    one of the same height as long as at the first, in a small part of the distance of two
    even places: the error of the strip came out 30% too large at eps = 5e-6.
    """
    count, width = place.size, float(held.max() - held.min())
    around = np.arange(-SETTINGS.beside_top, SETTINGS.beside_top + 1)
    places, values = [place], [held]
    for top in _others(held, width):
        index = top + around
        near = place[index % count] + index // count - place[top]
        found = _beside(near, held[index % count], float(held.max()), width)
        if found is not None:
            moved = place[top] + found[0]
            places.append(moved - np.floor(moved + 0.5))
            values.append(found[1])
    place, first = np.unique(np.concatenate(places), return_index=True)
    return place, np.concatenate(values)[first]


def _others(held: np.ndarray, width: float) -> np.ndarray:
    """Where a maximum is that is not the first one, and high enough to count."""
    rising, falling = held >= np.roll(held, 1), held > np.roll(held, -1)
    high = held > held.max() - SETTINGS.deep * width
    tops = np.flatnonzero(rising & falling & high)
    return tops[tops != int(np.argmax(held))]


def _beside(
    near: np.ndarray, values: np.ndarray, highest: float, width: float
) -> tuple[np.ndarray, np.ndarray] | None:
    """Places beside the maximum of a polynomial through these values, and its values.

    None where the values are no smooth maximum. What is as high as the highest one within
    the polynomial's error is of its height: cut off there it would be flat, and held tips.
    """
    size = float(np.abs(near).max())
    if (
        values[SETTINGS.beside_top] - max(values[0], values[-1])
        < SETTINGS.stands_out * width
    ):
        return None
    curve = np.polynomial.Polynomial.fit(
        near, values, SETTINGS.degree, domain=[-size, size]
    )
    slope, bend = curve.deriv(), curve.deriv(2)
    top = 0.0
    for _ in range(4):
        if not bend(top) < 0:
            return None
        top = top - slope(top) / bend(top)
    if not near[SETTINGS.beside_top - 1] < top < near[SETTINGS.beside_top + 1]:
        return None
    distance = np.geomspace(SETTINGS.closest, SETTINGS.width, SETTINGS.more)
    wanted = top + np.concatenate([-distance[::-1], [0.0], distance])
    below = highest - curve(top)
    if below < -SETTINGS.equal * width:
        return None
    height = highest if below < SETTINGS.equal * width else curve(top)
    return wanted, height - np.maximum(curve(top) - curve(wanted), 0.0)
