"""Whether a sampled curve solves the wiggly system, from the scene alone."""

import math
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from .._checks import (
    Outcome,
    Result,
    as_real,
    known_numbers,
    require,
    require_real,
    with_nan,
)
from ..effects import Engine
from ..model import Scene, coefficients_jit, require_reach, require_times, scene_for
from .curve import Force, along_curve, force_of
from .settings import SETTINGS
from .transits import folds_of, missing_forces, viscosity_ratio
from .tube import distance


class CertificateStatus(Outcome):
    """Why a curve is or is not accepted; `message` says it for people."""

    OK = 0, "the curve solves the wiggly system"
    NOT_FINITE = 1, "the curve holds values that are not finite"
    UNRESOLVED = 2, "samples are more than eps/4 apart: slips are not resolved"
    SKIPPED = 3, "a well was crossed without the force that this takes"
    OFF = 4, "the curve is too far from every solution"
    VISCOSITY = 5, "slips take another time than eps^gamma gives them"


class _Numbers(NamedTuple):
    residual: float
    residual_error: float
    scale: float
    slips: int
    skipped: int
    distance: float
    missing_force: float
    viscosity: float
    spacing: float
    status: CertificateStatus


class Certificate(Result, _Numbers):
    """What was found about a curve.

    `residual` of the energy-dissipation balance in J, `int (eps^gamma z' + D E)^2 /
    (2 eps^gamma)`, with its quadrature error `residual_error`; `scale = eps (rho_plus -
    rho_minus)`, the energy of one slip, in J. `slips`: wells crossed. `distance`: the
    curve is at least so far, in units of eps, from every solution. `missing_force`: the
    most that was missing when a well was left, in units of `Phi'' eps`, the force of one
    well. `viscosity`: measured in slips, relative to `eps^gamma`; NaN without slips.
    `skipped`: wells crossed without the force. `status`: a `CertificateStatus`; `ok`:
    whether the curve is within about eps/100 of a solution; `message`: the verdict.
    """

    __slots__ = ()


@with_nan
def certify(scene: Scene, eps: Any, gamma: Any, ts: Any, z: Any) -> Certificate:
    """Certify any sampled curve, whatever made it, against the scene alone.

    `eps` in m, `gamma` > 0; `ts` in s, increasing, in [0, duration]; `z` in m; shapes
    (n,), n >= 2, NumPy or JAX. The curve's start is not compared with the scene's `z0`.
    Needs slips sampled at eps/4 or finer; a tenth of eps is comfortable, and as much finer
    as the wells have flanks narrower than a sine's: a rod that hardly keeps its contact
    needs eps/500, and true curves are told `VISCOSITY` or `OFF` before.

    `ok` accepts a curve within eps/100 of a solution, whatever the deviation, and rejects
    one that skips a well, is shifted by eps/10 or has another gamma. The residual of the
    balance is reported but cannot decide that: a shift by eps/100 costs 270 slips at
    eps = 1e-3 and gamma = 1, a skipped well that is made slowly 1e-4 of a slip. What is
    not seen: a slip that comes early by a jump of less than 0.06 eps, once the load alone
    would have carried it over the fold.

    Raises `ValueError` for arguments out of range, 32 bits, or an eps at which the
    bristle loses its contact.
    """
    scene = scene_for(Engine.CERTIFICATE, scene)
    require_real("eps", eps, "eps > 0", lambda e: e > 0)
    require_real("gamma", gamma, "gamma > 0", lambda g: g > 0)
    ts, z = _require_curve(scene, ts, z)
    require_reach(scene.potential, jnp.asarray(as_real(eps)))
    eps = float(eps)
    viscosity = eps ** float(gamma)
    law = coefficients_jit(scene.potential)
    scale = eps * float(law.rho_plus - law.rho_minus)
    if not np.all(np.isfinite(z)):
        return _nothing_known(scale)
    force = force_of(scene, jnp.asarray(eps))
    at, on = along_curve(force, viscosity, ts, z)
    residual = float(np.sum(on.residual))
    folds = folds_of(force)
    missing = missing_forces(force, folds, at)
    measured = {
        "distance": distance(ts, z, at, on, eps, viscosity, 0.5 * scale / eps),
        "missing_force": float(np.max(missing, initial=-np.inf)),
        "viscosity": viscosity_ratio(folds, z, at, on) / viscosity,
        "spacing": float(np.max(np.abs(np.diff(z)))) / eps,
    }
    return Certificate(
        residual=residual,
        residual_error=_residual_error(force, viscosity, ts, z, residual),
        scale=scale,
        slips=missing.size,
        skipped=int(np.sum(missing > SETTINGS.missing_force)),
        status=_verdict(**measured),
        **measured,
    )


def _require_curve(scene: Scene, ts: Any, z: Any) -> tuple[np.ndarray, np.ndarray]:
    times, states = known_numbers(ts), known_numbers(z)
    require(times.ndim == 1 and times.size >= 2, "ts", ts, "times, shape (n,), n >= 2")
    times = np.asarray(require_times(scene, times), dtype=float)
    require(np.all(np.diff(times) > 0), "ts", times, "times that increase")
    shape = f"real states of the shape {times.shape} of ts"
    require(states.shape == times.shape, "z", z, shape)
    return times, states.astype(float)


def _nothing_known(scale: float) -> Certificate:
    unknown = math.nan
    return Certificate(
        residual=unknown,
        residual_error=unknown,
        scale=scale,
        slips=0,
        skipped=0,
        distance=unknown,
        missing_force=unknown,
        viscosity=unknown,
        spacing=unknown,
        status=CertificateStatus.NOT_FINITE,
    )


def _residual_error(force: Force, viscosity: float, ts, z, residual: float) -> float:
    """From the residual at every second sample: order 2 is claimed where h^6 can be met."""
    keep = np.unique(np.append(np.arange(0, ts.size, 2), ts.size - 1))
    _, on = along_curve(force, viscosity, ts[keep], z[keep])
    return abs(float(np.sum(on.residual)) - residual) / 3


def _verdict(
    *, distance: float, missing_force: float, viscosity: float, spacing: float
) -> CertificateStatus:
    """The first test that fails. NaN is no slip: nothing to measure the viscosity by."""
    if spacing > SETTINGS.coarsest:
        return CertificateStatus.UNRESOLVED
    if missing_force > SETTINGS.missing_force:
        return CertificateStatus.SKIPPED
    if abs(viscosity - 1) > SETTINGS.viscosity:
        return CertificateStatus.VISCOSITY
    return CertificateStatus.OK if distance <= SETTINGS.farthest else CertificateStatus.OFF
