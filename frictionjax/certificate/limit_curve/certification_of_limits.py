"""Whether a sampled curve solves the limit system, from the scene alone."""

import math
from typing import Any

import numpy as np

from ..._checks import require_real, with_nan
from ...effects import Engine
from ...model import (
    Scene,
    coefficients_jit,
    known_turning_points,
    require_curve,
    scene_for,
    strips_at,
)
from ...supports import AbstractSupport
from .limit_verdicts import LimitCertificate, LimitCertificateStatus
from .missing_energy import forces_at, missing_energy
from .nearest_solution import distance_from_solutions

__all__ = ["LimitCertificate", "LimitCertificateStatus", "certify_limit"]


@with_nan
def certify_limit(
    scene: Scene, ts: Any, z: Any, *, tolerance: Any = 1e-3
) -> LimitCertificate:
    """Certify any sampled curve against the limit system of a `scene` alone (eq. 2.3).

    For experiments, other codes, and motions at a small eps. `ts` in s, increasing, in
    [0, duration]; `z` in m; shapes (n,), n >= 2, NumPy or JAX. The curve's start is not
    compared with the scene's `z0`. Samples may be any distance apart, but nothing is known
    of a curve between them: the load's turning points are where mistakes show.

    `ok` where a solution of the limit system comes within `tolerance` of the curve at all
    samples: lengths over the width of the strip, forces over `rho_plus - rho_minus`. The
    nearest of all solutions is found exactly, as the flow is one clip after the other; no
    solver is asked. A motion at finite eps lags by a well or so: it is accepted from
    `tolerance` = 2 eps/width on, or what else its `sup_error` is.

    Returns a `LimitCertificate`: `.ok .status .message`, `.distance`, `.excess`, and
    `.residual` of the balance of energies and `.scale` in J.

    Raises `ValueError` for arguments out of range, 32 bits, and effects whose limit is
    another.

    >>> ts = np.linspace(0.0, 3.0, 301)
    >>> z = fx.solve_limit(scene, ts).z
    >>> fx.certify_limit(scene, ts, z).message
    'the curve solves the limit system'
    >>> fx.certify_limit(scene, ts, np.asarray(z) + 0.01).message
    'the curve leaves the strip: forces are beyond friction'
    """
    scene = scene_for(Engine.LIMIT_CERTIFICATE, scene)
    require_real("tolerance", tolerance, "tolerance > 0", lambda share: share > 0)
    return _certificate(scene, *require_curve(scene, ts, z), float(tolerance))


def _certificate(
    scene: Scene, ts: np.ndarray, z: np.ndarray, tolerance: float
) -> LimitCertificate:
    law = coefficients_jit(scene.potential)
    plus, minus = float(law.rho_plus), float(law.rho_minus)
    # Times between which the load is monotone, and the samples among them.
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    inside = turns[(turns > ts[0]) & (turns < ts[-1])]
    times = np.union1d(ts, inside)
    samples = np.searchsorted(times, ts)
    strips = strips_at(scene, plus, minus, times)
    loads, lower, upper = strips
    width = float(np.min(upper - lower))
    scale = (plus - minus) * width
    if not np.all(np.isfinite(z)):
        unknown = math.nan
        status = LimitCertificateStatus.NOT_FINITE
        return LimitCertificate(unknown, scale, unknown, unknown, tolerance, status)
    distance = distance_from_solutions(z, lower, upper, samples) / width
    excess = _excess(scene, loads[samples], z, plus, minus)
    residual = _residual(strips, scene.support, z, samples, (plus, minus))
    status = _verdict(distance, excess, tolerance)
    return LimitCertificate(residual, scale, distance, excess, tolerance, status)


def _excess(
    scene: Scene, loads: np.ndarray, z: np.ndarray, plus: float, minus: float
) -> float:
    """The most by which a force at a sample is beyond friction, over its interval."""
    forces = loads - forces_at(scene.support, z)
    beyond = np.maximum(forces - plus, minus - forces)
    return max(float(np.max(beyond)), 0.0) / (plus - minus)


def _residual(
    strips: tuple[np.ndarray, np.ndarray, np.ndarray],
    support: AbstractSupport,
    z: np.ndarray,
    samples: np.ndarray,
    rho: tuple[float, float],
) -> float:
    """The balance over all gaps between samples; `rho` to the right and to the left."""

    def on_the_way(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        first, last = samples[:-1], values[samples[1:]]
        least = np.minimum(np.minimum.reduceat(values, first), last)
        return least, np.maximum(np.maximum.reduceat(values, first), last)

    loads, lower, upper = map(on_the_way, strips)
    right = np.diff(z) > 0
    ends = [np.where(right, *pair) for pair in zip(lower, upper, strict=True)]
    return missing_energy(support, z, np.where(right, *rho), loads, (ends[0], ends[1]))


def _verdict(distance: float, excess: float, tolerance: float) -> LimitCertificateStatus:
    if excess > tolerance:
        return LimitCertificateStatus.OUTSIDE
    near = distance <= tolerance
    return LimitCertificateStatus.OK if near else LimitCertificateStatus.OFF
