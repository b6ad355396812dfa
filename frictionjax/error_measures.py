"""How far a computed trajectory is from its reference, in several measures."""

import numpy as np

from .references import Instants, Reference, relative_gap

_LEAST = 1e-17  # relative error that counts as none


def errors_of(
    z: np.ndarray, dissipation: np.ndarray, truth: Reference, when: Instants, eps: float
) -> dict[str, float]:
    """Errors of states (m) and dissipation (J) at the instants.

    `error`: the largest at the times asked for outside slips, in eps; `slip_error`: mean
    over a whole slip period; `end_error`: at the last time; `dissipation_error`: largest
    over the final value; `mescd`: -log10(|z - z_ref|/(eps + |z_ref|)) at the last time.
    """
    gaps = np.abs(z - truth.z) / eps
    asked = when.asked[~truth.in_slip[when.asked]]
    last = eps * gaps[-1] / (eps + abs(truth.z[-1]))
    nothing = float("nan")
    return {
        "error": float(gaps[asked].max()) if asked.size else nothing,
        "slip_error": float(gaps[when.slip].mean()) if when.slip.size else nothing,
        "end_error": float(gaps[-1]),
        "dissipation_error": relative_gap(dissipation, truth.dissipation),
        "mescd": -float(np.log10(np.maximum(last, _LEAST))),
    }
