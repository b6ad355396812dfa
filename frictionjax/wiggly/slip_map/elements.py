"""How a slide is cut into panels of wells, from what the averaged equation foresees.

Times of passage are singular where the slide sets off and where its force would vanish: a
panel may be the longer, the further away these are.
"""

import numpy as np

from .averaged_equation import Lags
from .settings import SETTINGS


def _ends_of(lags: Lags, late: float) -> tuple[float, float]:
    """Wells until a slide ends or turns slow, and until its force would be nothing."""
    calm = (
        (lags.force > 0) & (lags.kept > SETTINGS.slower) & (lags.kept < 1 / SETTINGS.slower)
    )
    on = np.append(calm & (lags.time < late), False)
    k = max(int(np.argmin(on)) - 1, 1)
    fall = (lags.force[k - 1] - lags.force[k]) / (lags.number[k] - lags.number[k - 1])
    nothing = lags.number[k] + lags.force[k] / fall if fall > 0 else np.inf
    if k + 1 == on.size - 1 or not calm[k + 1]:
        return float(lags.number[k]), nothing
    ends = lags.number[k : k + 2]
    return float(np.interp(late, lags.time[k : k + 2], ends)) - SETTINGS.end, nothing


def _spans(wells: float, tail: float, side: float, left: float = 1.0) -> float:
    """Wells of a panel that begins or (`side` -1) so far from a singular point, at most.

    Coefficients fall like `rho^-k`, with `(rho + 1/rho)/2` the distance of the point from
    the panel's middle over half its span, from about the wells that the panel spans, of
    which `left` is not yet forgotten.
    """
    rho = max(2 * wells * left / tail, 1.0) ** (1 / SETTINGS.degree)
    return 2 * wells / max(0.5 * (rho + 1 / rho) - side, 2 / SETTINGS.growth)


def edges_of(
    lags: Lags, late: float, left: float, since: float, tail: float, share: float
) -> np.ndarray:
    """Edges of panels from 0 to where a slide ends, in wells.

    At `late` (s) at most, as far as the averaged equation knows, and `left` wells on.

    Narrower near the set-off, `since` wells before, and near where the force would vanish,
    which matters until it is forgotten. `tail`: last coefficients allowed, wells.
    `share`: of the spans that seem right, for the first panel: what was too wide there need
    not be so further on.
    """
    (end, nothing), edges = _ends_of(lags, late), [0.0]
    end = min(end, left - SETTINGS.end)
    while end - edges[-1] >= SETTINGS.smallest:
        begun = SETTINGS.before + since + edges[-1]
        kept = np.interp(edges[-1], lags.number, lags.kept)
        span = _spans(begun, tail, 1.0, min(kept, 1.0) ** begun)
        if np.isfinite(nothing):
            span = min(span, _spans(max(nothing - edges[-1], 1.0), tail, -1.0))
        span = np.floor(max(share * span, SETTINGS.smallest))
        share = share**SETTINGS.recovers
        rest = np.floor(end - edges[-1])
        if span < rest < SETTINGS.stretch * span and np.isfinite(nothing):
            span = max(np.ceil(SETTINGS.first_of_two * rest), SETTINGS.smallest)
        elif rest < SETTINGS.stretch * span:
            span = rest
        edges.append(edges[-1] + span)
    return np.array(edges)
