"""What eq. 2.8 asks of a given Q: 1-periodic, and bounded as eps -> 0."""

import numpy as np

from .._checks import require
from .digits import Noises, noises, require_digits
from .potentials import AbstractPotential, GivenPotential

_SEAM = 1e-6  # of the largest value, as of W
_ABOVE_NOISE = 20.0  # times the median, which a jump of noise stays below
_STEP, _GREATER, _LESS = 8.0, 2, 8  # eps times 64 to eps/8^8: over 9 decades
# 1/sqrt(eps) grows by 2.8 in such a step, log(eps) by 1.8 at most from eps = 0.01 on. What
# settles down somewhere, as 1/(eps + 1e-4), is bounded, if large.
_GROWS = 2.5
_FELT = 1e-9  # of the range of W': of less than that no force knows


def require_given(potential: AbstractPotential, eps: np.ndarray) -> None:
    """Check a given W and Q at every eps in use (n,), rising.

    Digits first (`require_digits`); then that Q and Q' agree at both ends of the period;
    and that they do not grow in every step of eight from 64 times the smallest eps to
    1e-7 times it: rho would not be the largest W' (Lemma 2). Raises `ValueError`.
    """
    if not isinstance(potential, GivenPotential):
        return
    found = noises(potential, eps)
    require_digits(found, eps)
    _require_periodic(found, eps)
    _require_bounded(potential, float(eps[0]))


def _require_periodic(found: Noises, eps: np.ndarray) -> None:
    size = found.largest
    noise = np.stack([found.q * size, found.change * found.range / eps], axis=1)
    allowed = _SEAM * size[:, None] + _ABOVE_NOISE * noise
    wrong = found.seam > allowed
    if not wrong.any():
        return
    which, order = (int(i) for i in np.argwhere(wrong)[0])
    jump = f"{('Q', 'its slope')[order]} jumps by {found.seam[which, order]:.3g}"
    name = f"potential.Q at eps = {eps[which]:.6g}"
    require(False, name, f"{jump} at the seam Y = 0", "a 1-periodic C^2 function of Y")


def _require_bounded(potential: GivenPotential, least: float) -> None:
    sizes = least * _STEP ** np.arange(_GREATER, -_LESS - 1, -1.0)
    found = noises(potential, sizes)
    largest, now = found.largest, _GREATER
    with np.errstate(all="ignore"):
        growth = largest[1:] / largest[:-1]
    # What has no value at a larger eps, or overflows at a smaller one, tells nothing.
    grows = bool(np.all(np.isnan(growth) | (growth > _GROWS)))
    felt = least * largest[now] > _FELT * found.range[now]
    known = np.isfinite(growth[now - 1]) or np.isfinite(growth[now])
    name = f"potential.Q at eps = {least:.6g}"
    said = (
        f"|Q| and |Q'| up to {largest[now]:.3g}, {growth[now]:.3g} times as much at eps/8"
    )
    needs = "Q and Q' bounded as eps -> 0 (eq. 2.8), or rho is not the largest W'"
    require(not (grows and felt and known), name, said, needs)
