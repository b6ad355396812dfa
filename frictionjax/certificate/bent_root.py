"""A root over its pinned tip, the rod between them bent: a curve of its own equation."""

import numpy as np

from .._checks import Real
from ..loads import AbstractPull
from ..supports import AbstractSupport
from ..turning import BentForce
from .curve import along_curve, every_second
from .forces import AbstractForce, AtTip
from .plain_curve import CurveMeasures, residual_error, verdict
from .tube import CurveSystem, distances_by_windows
from .verdicts import Certificate


class BentForceOnRoot(AbstractForce):
    """`l(t) - Phi'(z) - U'(x)` in N, `x = z - above` how far the root is ahead of the tip.

    y is z/eps, and there are no wells. `above`: the state in m with the root above the tip.
    """

    rod: BentForce
    above: Real
    support: AbstractSupport
    load: AbstractPull
    eps: Real

    def tip(self, z: Real) -> tuple[Real, Real]:
        return 0.0 * z, z / self.eps

    def at_tip(self, well: Real, y: Real) -> AtTip:
        force = self.rod.force(self.eps * y - self.above)
        return AtTip(force, 1.0 + 0.0 * y, self.eps * (well + y))


def bent_certificate(
    force: BentForceOnRoot, viscosity: float, scale: float, ts: np.ndarray, z: np.ndarray
) -> Certificate:
    """Of finite samples; `viscosity` is `eps^gamma`, `scale` the energy of a slip in J."""
    eps = float(force.eps)
    at, on = along_curve(force, viscosity, ts, z)
    residual = float(np.sum(on.residual))
    thinned = every_second(ts.size)
    _, on_half = along_curve(force, viscosity, ts[thinned], z[thinned])
    bend = float(np.max(np.abs(at.bend)))
    system = CurveSystem(eps, viscosity, 0.5 * scale / eps, bend)
    by_windows = distances_by_windows(ts, z, at, on, system)
    measured = CurveMeasures(
        distance=by_windows.nearby,
        within=np.inf,
        missing_force=-np.inf,
        viscosity=np.nan,
        spacing=float(np.max(np.abs(np.diff(z)))) / eps,
    )
    return Certificate(
        residual=residual,
        residual_error=residual_error(on_half, residual),
        scale=scale,
        slips=0,
        skipped=0,
        status=verdict(measured),
        **measured._replace(distance=by_windows.least)._asdict(),
    )
