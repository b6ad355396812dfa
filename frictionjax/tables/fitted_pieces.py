"""Polynomials that meet a function to rounding, on pieces halved until they do."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float
from numpy.polynomial import Chebyshev, Polynomial, chebyshev

from .pieces import Pieces
from .settings import SETTINGS

_COUNT = SETTINGS.degree + 1
# Where pieces meet the function, and where they are held against it, shares of a piece. At
# both ends too, if less closely, as kinks may be a rounding away: what rises within less
# than the distance of two nodes has risen there.
_NODES = 0.5 - 0.5 * np.cos(np.pi * (np.arange(_COUNT) + 0.5) / _COUNT)
_BETWEEN = 0.5 - 0.5 * np.cos(np.pi * np.arange(_COUNT + 1) / _COUNT)
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(2 * _NODES - 1, SETTINGS.degree))
_AT_BETWEEN = chebyshev.chebvander(2 * _BETWEEN - 1, SETTINGS.degree)
# Rows: Chebyshev polynomials on [0, 1] as powers.
_TO_POWERS = np.stack(
    [
        np.pad(term.coef, (0, _COUNT - term.coef.size))
        for term in (
            Chebyshev.basis(k, domain=[0, 1]).convert(kind=Polynomial)
            for k in range(_COUNT)
        )
    ]
)


def fitted_pieces(
    fn: Callable[[np.ndarray], np.ndarray], edges: Float[np.ndarray, " n"]
) -> Pieces | None:
    """Pieces of a function on [0, 1), smooth between `edges`, which rise from 0 to 1.

    None where that takes more of them than tables have room for. By way of Chebyshev
    series: powers of values at nodes at once would lose six digits.
    """
    left, width = edges[:-1], np.diff(edges)
    most, largest = SETTINGS.pieces[-1] - SETTINGS.few, 0.0
    done: list[tuple[np.ndarray, np.ndarray]] = []
    while left.size:
        if left.size + sum(begins.size for begins, _ in done) > most:
            return None
        places = left[:, None] + width[:, None] * np.append(_NODES, _BETWEEN)
        values = fn(places.ravel()).reshape(places.shape)
        if not np.all(np.isfinite(values)):
            return None
        largest = max(largest, float(np.max(np.abs(values))))
        series = values[:, :_COUNT] @ _TO_SERIES.T
        off = np.abs(series @ _AT_BETWEEN.T - values[:, _COUNT:])
        # What a place is rounded by moves values where they are steep.
        noise = SETTINGS.place_rounding * np.ptp(values, axis=1) / width
        good = off[:, 1:-1].max(axis=1) <= SETTINGS.fitted * largest + noise
        good &= off[:, [0, -1]].max(axis=1) <= SETTINGS.same * largest + noise
        powers = series[good] @ _TO_POWERS / width[good, None] ** np.arange(_COUNT)
        done.append((left[good], powers))
        left, width = left[~good], 0.5 * width[~good]
        left, width = np.append(left, left + width), np.tile(width, 2)
    begins, terms = (np.concatenate(column) for column in zip(*done, strict=True))
    order = np.argsort(begins)
    return Pieces(begins[order], terms[order])
