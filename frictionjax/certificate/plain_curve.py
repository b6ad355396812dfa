"""A curve of the plain system, or of its effects that change the potential or only read."""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from ..model import Scene, known_turning_points, padded_edges
from .curve import CurveSamples, Intervals, along_curve, every_second
from .following import FollowedCurve, distances_from_rests
from .forces import Force, force_in_tables, force_of
from .settings import SETTINGS
from .transits import (
    fast_parts,
    folds_of,
    missing_forces,
    most_forgetful,
    viscosity_ratio,
)
from .tube import CurveSystem, distances_by_windows
from .verdicts import Certificate, CertificateStatus


class CurveMeasures(NamedTuple):
    """What verdicts go by, each as in a `Certificate`."""

    distance: float
    within: float
    missing_force: float
    viscosity: float
    spacing: float


def plain_certificate(
    scene: Scene, eps: float, viscosity: float, scale: float, ts, z
) -> Certificate:
    """Of finite samples; `viscosity` is `eps^gamma`, `scale` the energy of a slip in J."""
    force = force_in_tables(force_of(scene, jnp.asarray(eps)), ts)
    turning_points = known_turning_points(scene.load, scene.duration, scene.turns)
    stops = padded_edges(turning_points, scene.duration)
    return certificate_under(force, viscosity, scale, ts, z, stops)


def certificate_under(
    force: Force, viscosity: float, scale: float, ts, z, stops: Float[np.ndarray, " s"]
) -> Certificate:
    """The same under a force that is known; `stops`: when its load turns, in s."""
    eps = float(force.eps)
    at, on = along_curve(force, viscosity, ts, z)
    residual = float(np.sum(on.residual))
    folds = folds_of(force)
    missing = missing_forces(force, folds, at)
    columns = at.well, at.inside, at.force, at.stretch, at.pace
    curve = FollowedCurve(ts, z, *columns, stops)
    rests = distances_from_rests(force, viscosity, curve, most_forgetful(folds, at))
    least = nearby = rests.least
    if not rests.most <= SETTINGS.surely:
        bend = _most_bent(force, viscosity, at, ts, z)
        system = CurveSystem(eps, viscosity, 0.5 * scale / eps, bend)
        by_windows = distances_by_windows(ts, z, at, on, system)
        least, nearby = (max(one, rests.least) for one in by_windows)
    thinned = every_second(ts.size)
    at_half, on_half = along_curve(force, viscosity, ts[thinned], z[thinned])
    fast = fast_parts(folds, ts, z, at, on)
    fast_half = fast_parts(folds, ts[thinned], z[thinned], at_half, on_half)
    ratio, coarse = (viscosity_ratio(f, viscosity, eps) for f in (fast, fast_half))
    measured = CurveMeasures(
        distance=nearby,
        within=rests.most,
        missing_force=float(np.max(missing, initial=-np.inf)),
        viscosity=ratio,
        spacing=float(np.max(np.abs(np.diff(z)))) / eps,
    )
    return Certificate(
        residual=residual,
        residual_error=residual_error(on_half, residual),
        scale=scale,
        slips=missing.size,
        skipped=int(np.sum(missing > SETTINGS.missing_force)),
        status=verdict(measured, abs(coarse - ratio)),
        **measured._replace(distance=least)._asdict(),
    )


def _most_bent(force: Force, viscosity: float, at: CurveSamples, ts, z) -> float:
    """The largest |f_zz| in N/m^2, along the curve and in a whole well."""
    places = np.linspace(0.0, 1.0, SETTINGS.places_of_bend)
    times = ts[0] + places * (ts[-1] - ts[0])
    well, _ = along_curve(force, viscosity, times, z[0] + float(force.eps) * places)
    return float(np.nanmax(np.abs(np.concatenate([at.bend, well.bend]))))


def residual_error(thinned: Intervals, residual: float) -> float:
    """From the residual at every second sample: order 2 is claimed where h^6 can be met."""
    return abs(float(np.sum(thinned.residual)) - residual) / 3


def together(found: list[Certificate]) -> Certificate:
    """Of several curves: sums, and the worst of them."""
    statuses = [one.status for one in found]
    return Certificate(
        residual=sum(one.residual for one in found),
        residual_error=sum(one.residual_error for one in found),
        scale=found[0].scale,
        slips=sum(one.slips for one in found),
        skipped=sum(one.skipped for one in found),
        distance=max(one.distance for one in found),
        within=max(one.within for one in found),
        missing_force=max(one.missing_force for one in found),
        viscosity=_farthest_from_1([one.viscosity for one in found]),
        spacing=max(one.spacing for one in found),
        status=min(statuses, key=_IN_TURN.index),
    )


def _farthest_from_1(ratios: list[float]) -> float:
    """NaN, of curves that do not slip, where all are."""
    return max(ratios, key=lambda ratio: -1.0 if np.isnan(ratio) else abs(ratio - 1))


_IN_TURN = (
    CertificateStatus.NOT_FINITE,
    CertificateStatus.UNRESOLVED,
    CertificateStatus.SKIPPED,
    CertificateStatus.VISCOSITY,
    CertificateStatus.OFF,
    CertificateStatus.OK,
)


def verdict(measured: CurveMeasures, coarser: float = 0.0) -> CertificateStatus:
    """The first test that fails. NaN is no slip: nothing to measure the viscosity by.

    `coarser`: by how much the viscosity is another one from every second sample. Slips in
    few samples tell little of it: where a solution is known to be near they are let pass,
    and elsewhere what is off by no more than that is undecided.
    """
    if measured.spacing > SETTINGS.coarsest:
        return CertificateStatus.UNRESOLVED
    near = measured.distance <= SETTINGS.farthest
    surely = near and measured.within <= SETTINGS.surely
    if not surely and measured.missing_force > SETTINGS.missing_force:
        return CertificateStatus.SKIPPED
    off = abs(measured.viscosity - 1)
    least = SETTINGS.coarser * off if surely else off - SETTINGS.viscosity
    told = coarser <= least  # not, too, where half the samples tell nothing, NaN
    if off > SETTINGS.viscosity and (told or not surely):
        return CertificateStatus.VISCOSITY if told else CertificateStatus.UNRESOLVED
    return CertificateStatus.OK if near else CertificateStatus.OFF
