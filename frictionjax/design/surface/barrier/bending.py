"""Least bending energy of a surface with given extreme slopes.

Claim. Among the profiles of N harmonics with `max w' = P`, `min w' = -M` let P >= M (else
reflect). With `k(y) = sum_n 2 cos(2 pi n y)/(2 pi n)^2`, the reproducing kernel of
`int v'^2` for `v = w'`, and `r = k(0)/|k(1/2)|` (1.93 at N = 16, 2 as N grows):

- P <= r M: the optimum is the one combination of k(y) and k(y - 1/2) with v(0) = P and
  v(1/2) = -M. As N grows it becomes two parabolas, between extrema half a period apart.
- P > r M: -M is touched along a stretch around 1/2; a convex quadratic program.

Proof. Without the range, v(0) = P and v(d) = -M cost `(k0 (P^2 + M^2) + 2 k(d) P M) /
(k0^2 - k(d)^2)`, whose derivative in k(d) has the sign of `(P k(d) + M k0)(M k(d) + P k0)`:
least where k(d) is smallest, as long as `k(d) >= -k0 M/P`. k falls on (0, 1/2), for
`-k'/2 = sum sin(2 pi n y)/(2 pi n) > 0` there (Fejer, Jackson, Gronwall), so d = 1/2, and
P <= r M is what keeps within that. There v = lambda k(y) + nu k(y - 1/2), nu <= 0, falls on
(0, 1/2) too, term by term, so it keeps the range. For P > r M the free minimum lambda k
undershoots -M: v(0) = P and v >= -M alone, convex, attain both ends.

Bounds on |w''| leave d = 1/2 best as N grows (symmetric decreasing rearrangement keeps
the range and the mean and raises no slope); bounds on the height of w do not.
"""

from functools import cache
from typing import Any

import numpy as np


@cache
def kernel_ratio(harmonics: int) -> float:
    """`k(0)/|k(1/2)|`: up to this ratio of extreme slopes nothing is flattened."""
    squares = 1 / np.arange(1, harmonics + 1) ** 2.0
    signs = (-1.0) ** np.arange(harmonics)
    return float(np.sum(squares) / np.sum(signs * squares))


def free_energy(plus: Any, minus: Any, harmonics: int) -> Any:
    """`int w''^2` of the least bent profile through both ends half a period apart.

    Exact where the ratio of `plus` and `minus` = -omega_minus is within `kernel_ratio`,
    and a lower bound beyond.
    """
    odd, even = _odd_and_even(harmonics)
    return 0.5 * np.pi**2 * ((plus + minus) ** 2 / odd + (plus - minus) ** 2 / even)


@cache
def _odd_and_even(harmonics: int) -> tuple[float, float]:
    n = np.arange(1, harmonics + 1)
    odd = float(np.sum(1 / n[n % 2 == 1] ** 2.0))
    return odd, float(np.sum(1 / n[n % 2 == 0] ** 2.0)) if harmonics > 1 else np.inf


def bending_energy(cos: Any, sin: Any) -> float:
    """`int_0^1 w''^2` of a Fourier series of heights."""
    turns = 2 * np.pi * np.arange(1, np.size(cos) + 1)
    waves = np.asarray(cos) ** 2 + np.asarray(sin) ** 2
    return float(0.5 * np.sum(turns**4 * waves))
