"""How far a computed trajectory is from another one, in several measures."""

import numpy as np

from .instants import Instants
from .settings import SETTINGS

MEASURES = ("error", "slip_error", "end_error", "dissipation_error", "mescd")


def errors_of(
    z: np.ndarray,
    dissipation: np.ndarray,
    true_z: np.ndarray,
    true_dissipation: np.ndarray,
    in_slip: np.ndarray,
    when: Instants,
    eps: float,
) -> dict[str, float]:
    """Errors of states (m) and dissipation (J) at the instants, all of shape (n,).

    `error`: the largest at the times asked for outside slips, in eps; `slip_error`: mean
    over a whole slip period; `end_error`: at the last time asked for; `dissipation_error`:
    largest at the times asked for, over the true value at the last of them, 0 where that
    is 0; `mescd`: -log10(|z - z_true|/(eps + |z_true|)) at the last time asked for. NaN
    where no time counts, or nothing is known.
    """
    asked, last = when.asked, when.asked[-1]
    gaps = np.abs(z - true_z) / eps
    counted = gaps[asked[~in_slip[asked]]]
    relative = eps * gaps[last] / (eps + abs(true_z[last]))
    final = true_dissipation[last]
    off = np.abs(dissipation - true_dissipation)[asked].max()
    nothing = float("nan")
    share = off / final if final > 0 else 0.0 * (off + final)  # NaN stays
    return {
        "error": float(counted.max()) if counted.size else nothing,
        "slip_error": float(gaps[when.slip].mean()) if when.slip.size else nothing,
        "end_error": float(gaps[last]),
        "dissipation_error": float(share),
        "mescd": -float(np.log10(np.maximum(relative, SETTINGS.least_relative))),
    }
