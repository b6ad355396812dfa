"""Which coefficients a surface within the bounds can reach, in numbers."""

from typing import Any

import jax
import numpy as np

from ..._checks import as_text, no_less, no_more
from ...numerics import rows_of
from ..common import AbstractLaw, FreeLaw, Geometry, extreme_slopes
from .settings import SETTINGS


def slopes_asked(known: Geometry, coefficients: np.ndarray) -> np.ndarray:
    """Extreme slopes (omega_plus, -omega_minus) of each target, (targets, 2).

    NaN where no slope gives the coefficient.
    """
    rho_plus, rho_minus = coefficients.T
    plus, minus = extreme_slopes(rho_plus, rho_minus, known.a, known.alpha)
    both = np.stack([plus, -minus], axis=1)
    return np.where(np.isfinite(both) & (both > 0), both, np.nan)


def followed(known: Geometry, slopes: np.ndarray) -> bool:
    """Whether every bristle follows the slopes that its target asks for."""
    limits = np.stack([known.upper, -np.asarray(known.lower)], axis=1)
    return bool(np.all(slopes < limits))


def limits_of(law: AbstractLaw, free: Any) -> list[tuple[float, float]]:
    """`coefficient_limits` of each target; the widest where bristles have free numbers."""
    if not isinstance(law, FreeLaw):
        return [coefficient_limits(one) for one in _each(law.at(free))]
    own, count = np.asarray(law.shares()), len(law.free)
    shares = np.random.default_rng(0).uniform(size=(SETTINGS.samples, count))
    few = count <= SETTINGS.corners
    corners = np.indices((2,) * count).reshape(count, -1).T if few else own
    shares = np.concatenate([own[None], np.atleast_2d(free), shares, corners])
    known = jax.jit(jax.vmap(law.at))(shares)
    rows = []
    for index in range(known.alpha.shape[1]):
        some = rows_of(known, np.s_[:, index])
        ends = [coefficient_limits(one) for one in _each(some) if _alike(one, some)]
        rows.append((max(high for high, _ in ends), min(low for _, low in ends)))
    return rows


def _each(known: Geometry) -> list[Geometry]:
    return [Geometry._make(map(float, row)) for row in zip(*known, strict=True)]


def _alike(one: Geometry, every: Geometry) -> bool:
    """Whether a bristle presses the way that the first does."""
    return bool(np.isfinite(one.a) and one.alpha * every.alpha[0] > 0)


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
    bounded = stretch > SETTINGS.no_stretch
    return omega / stretch if bounded else float(np.copysign(np.inf, omega))


def reachable_text(
    limits: list[tuple[float, float]],
    harmonics: int,
    asked: np.ndarray,
    within: str = "",
    most: str = "",
) -> str:
    """The reachable set in words, one sentence.

    `limits`: of each target's coefficients; `asked`: slopes of `slopes_asked`. `within`:
    what the bounds on the surface leave room for, if there are any. `most`: the largest
    ratio of slopes seen, where it is not the number of harmonics.
    """
    most = most or str(harmonics)
    parts = []
    for index, (high, low) in enumerate(limits):
        name = f"targets[{index}]: " if len(limits) > 1 else ""
        span = [f"rho_plus < {no_more(high)} N"] if np.isfinite(high) else []
        span += [f"rho_minus > {no_less(low)} N"] if np.isfinite(low) else []
        parts.append(f"{name}{' and '.join(span) or 'any rho_plus > 0 > rho_minus'}")
    ratios = ", ".join(as_text(p / m) for p, m in asked if np.isfinite(p / m))
    parts.append(
        f"omega_plus/|omega_minus| from 1/{most} to {most} with {harmonics} "
        f"harmonics{f' (asked for: {ratios})' if ratios else ''}"
    )
    return "reachable: " + "; ".join([*parts, within] if within else parts)


def share_text(share: float, slopes: np.ndarray) -> str:
    """How much `steepest_surface` found of these slopes (omega_plus, -omega_minus)."""
    return (
        f"{no_more(share, 4)} of the slopes asked for, {as_text(slopes[0])} and "
        f"{as_text(-slopes[1])}, within the bounds on the surface"
    )
