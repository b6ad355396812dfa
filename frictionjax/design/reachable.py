"""Which coefficients a surface within the bounds can reach, in numbers."""

from typing import Any

import numpy as np

from ..arguments import as_text
from .constraints import ORDERS, Layout, basis
from .targets import Geometry


def coefficient_limits(known: Geometry) -> tuple[float, float]:
    """Ends of the coefficients (N) that slopes the bristle can follow give.

    `rho_plus` lies between 0 and the first, `rho_minus` between the second and 0.
    """
    high = known.alpha * _mu(known.a, known.upper)
    low = known.alpha * _mu(known.a, known.lower)
    return max(high, low), min(high, low)


def _mu(a: float, omega: float) -> float:
    """`omega/(1 + a omega)` (Lemma 3) with its limits at infinity and at `-1/a`."""
    if np.isinf(omega):
        return 1 / a if a * omega > 0 else omega
    stretch = 1 + a * omega
    return omega / stretch if stretch > 1e-12 else float(np.copysign(np.inf, omega))


def reachable_share(
    layout: Layout, plus: float, minus: float, curvature: float, height: float
) -> float:
    """The largest multiple of the slopes (`plus`, -`minus`) that the bounds leave room for.

    A linear program (HiGHS), the lowest slope half a period from the highest.
    """
    from scipy.optimize import linprog  # 0.3 s, for targets out of reach only

    slopes, bends, heights = (basis(layout.harmonics, layout.points, k) for k in ORDERS)
    half, none = layout.points // 2, np.zeros((layout.points, 1))
    one = none + 1
    blocks = [
        (slopes, -plus * one, none, none, 0.0),
        (-slopes, -minus * one, none, none, 0.0),
        (-slopes[:1], plus * one[:1], none[:1], none[:1], 0.0),
        (slopes[half : half + 1], minus * one[:1], none[:1], none[:1], 0.0),
    ]
    if layout.sharp:
        blocks += [(side * bends, none, none, none, curvature) for side in (1, -1)]
    if layout.high:
        blocks += [(heights, none, -one, none, 0.0), (-heights, none, none, -one, 0.0)]
        blocks += [(0 * slopes[:1], none[:1], one[:1], one[:1], height)]
    rows = np.concatenate([np.concatenate(block[:4], axis=1) for block in blocks])
    ends = np.concatenate([np.full(len(block[0]), block[4]) for block in blocks])
    aim = np.zeros(rows.shape[1])
    aim[-3] = -1.0
    found = linprog(aim, rows, ends, bounds=(None, None), method="highs")
    return float(-found.fun) if found.status == 0 else np.inf


def reachable_text(
    names: list[str],
    geometries: list[Geometry],
    harmonics: int,
    wanted: Any,
    share: float | None,
) -> str:
    """The reachable set in words, one sentence.

    `wanted`: extreme slopes (omega_plus, -omega_minus) that the targets ask for; `share`:
    the part of them that bounds on curvature and height leave room for, None without.
    """
    parts = []
    for name, known in zip(names, geometries, strict=True):
        high, low = coefficient_limits(known)
        span = [f"rho_plus < {as_text(high)} N"] if np.isfinite(high) else []
        span += [f"rho_minus > {as_text(low)} N"] if np.isfinite(low) else []
        parts.append(f"{name}{' and '.join(span) or 'any rho_plus > 0 > rho_minus'}")
    plus, minus = (float(value) for value in wanted)
    ratio = plus / minus if plus > 0 and minus > 0 else np.nan
    asked = f" (asked for: {as_text(ratio)})" if np.isfinite(ratio) else ""
    parts.append(
        f"omega_plus/|omega_minus| from 1/{harmonics} to {harmonics} with {harmonics} "
        f"harmonics{asked}"
    )
    if share is not None and np.isfinite(ratio):
        parts.append(
            f"{as_text(min(share, 1.0))} of the slopes asked for, {as_text(plus)} and "
            f"{as_text(-minus)}, within the bounds on the surface"
        )
    return "reachable: " + "; ".join(parts)
