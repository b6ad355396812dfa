"""What eq. 2.6 asks of a given Q: 1-periodic, and bounded as eps -> 0."""

import numpy as np

from .._checks import require
from .digits import Noises, noises, require_digits
from .potentials import AbstractPotential, GivenPotential, no_rest
from .settings import SETTINGS


def require_given(potential: AbstractPotential, eps: np.ndarray) -> None:
    """Check a given Q, and W beside it, at every eps in use (n,), rising.

    Digits first (`require_digits`); then that Q and Q' agree at both ends of the period;
    and that they do not grow in every step of eight from 64 times the smallest eps to
    1e-7 times it: rho would not be the largest W' (Lemma 2). Raises `ValueError`.
    """
    if not isinstance(potential, GivenPotential) or potential.Q_fn is no_rest:
        return  # W alone was made without a jump of 1e-9: less than is asked here
    found = noises(potential, eps)
    require_digits(found, eps)
    _require_periodic(found, eps)
    _require_bounded(potential, float(eps[0]))


def _require_periodic(found: Noises, eps: np.ndarray) -> None:
    size = found.largest
    noise = np.stack([found.q * size, found.change * found.range / eps], axis=1)
    allowed = SETTINGS.seam * size[:, None] + SETTINGS.above_noise * noise
    wrong = found.seam > allowed
    if not wrong.any():
        return
    which, order = (int(i) for i in np.argwhere(wrong)[0])
    jump = f"{('Q', 'its slope')[order]} jumps by {found.seam[which, order]:.3g}"
    name = f"potential.Q at eps = {eps[which]:.6g}"
    require(False, name, f"{jump} at the seam Y = 0", "a 1-periodic C^2 function of Y")


def _require_bounded(potential: GivenPotential, least: float) -> None:
    sizes = least * SETTINGS.eps_ratio ** np.arange(
        SETTINGS.greater, -SETTINGS.less - 1, -1.0
    )
    found = noises(potential, sizes)
    largest, now = found.largest, SETTINGS.greater
    with np.errstate(all="ignore"):
        growth = largest[1:] / largest[:-1]
    # What has no value at a larger eps, or overflows at a smaller one, tells nothing.
    grows = bool(np.all(np.isnan(growth) | (growth > SETTINGS.grows)))
    felt = least * largest[now] > SETTINGS.felt * found.range[now]
    known = np.isfinite(growth[now - 1]) or np.isfinite(growth[now])
    name = f"potential.Q at eps = {least:.6g}"
    said = (
        f"|Q| and |Q'| up to {largest[now]:.3g}, {growth[now]:.3g} times as much at eps/8"
    )
    needs = "Q and Q' bounded as eps -> 0 (eq. 2.6), or rho is not the largest W'"
    require(not (grows and felt and known), name, said, needs)
