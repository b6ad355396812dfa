"""Polynomials that meet a function to rounding, on pieces halved until they do."""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from numpy.polynomial import Chebyshev, Polynomial, chebyshev

from .pieces import Pieces
from .settings import SETTINGS


class _Fit(NamedTuple):
    """Where pieces of a degree meet the function and are held against it, and how.

    `nodes`, `between`: shares of a piece. Between at both ends too, if less closely, as
    kinks may be a rounding away: what rises within less than the distance of two nodes has
    risen there. `to_powers`: rows are Chebyshev polynomials on [0, 1] as powers.
    """

    nodes: Float[np.ndarray, " terms"]
    between: Float[np.ndarray, " more"]
    to_series: Float[np.ndarray, "terms terms"]
    at_between: Float[np.ndarray, "more terms"]
    to_powers: Float[np.ndarray, "terms terms"]


@cache
def _fit(degree: int) -> _Fit:
    count = degree + 1
    nodes = 0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / count)
    between = 0.5 - 0.5 * np.cos(np.pi * np.arange(count + 1) / count)
    terms = (Chebyshev.basis(k, domain=[0, 1]) for k in range(count))
    powers = (term.convert(kind=Polynomial).coef for term in terms)
    return _Fit(
        nodes,
        between,
        np.linalg.inv(chebyshev.chebvander(2 * nodes - 1, degree)),
        chebyshev.chebvander(2 * between - 1, degree),
        np.stack([np.pad(coef, (0, count - coef.size)) for coef in powers]),
    )


def fitted_pieces(
    fn: Callable[[np.ndarray], np.ndarray],
    edges: Float[np.ndarray, " n"],
    degree: int = SETTINGS.degree,
    fitted: float = SETTINGS.fitted,
    most: int = SETTINGS.pieces - SETTINGS.few,
) -> Pieces | None:
    """Pieces of a function on [0, 1), smooth between `edges`, which rise from 0 to 1.

    None where that takes more than `most`, for which tables have room. By way of Chebyshev
    series: powers of values at nodes at once would lose six digits.
    """
    fit, count = _fit(degree), degree + 1
    left, width = edges[:-1], np.diff(edges)
    largest = 0.0
    done: list[tuple[np.ndarray, np.ndarray]] = []
    while left.size:
        if left.size + sum(begins.size for begins, _ in done) > most:
            return None
        places = left[:, None] + width[:, None] * np.append(fit.nodes, fit.between)
        values = fn(places.ravel()).reshape(places.shape)
        if not np.all(np.isfinite(values)):
            return None
        largest = max(largest, float(np.max(np.abs(values))))
        series = values[:, :count] @ fit.to_series.T
        off = np.abs(series @ fit.at_between.T - values[:, count:])
        # What a place is rounded by moves values where they are steep.
        noise = SETTINGS.place_rounding * np.ptp(values, axis=1) / width
        good = off[:, 1:-1].max(axis=1) <= fitted * largest + noise
        good &= off[:, [0, -1]].max(axis=1) <= SETTINGS.same * largest + noise
        powers = series[good] @ fit.to_powers / width[good, None] ** np.arange(count)
        done.append((left[good], powers))
        left, width = left[~good], 0.5 * width[~good]
        left, width = np.append(left, left + width), np.tile(width, 2)
    begins, terms = (np.concatenate(column) for column in zip(*done, strict=True))
    order = np.argsort(begins)
    return Pieces(begins[order], terms[order])
