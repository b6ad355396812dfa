"""Rosenbrock, exponential Rosenbrock and Radau IIA on the same slips; prints Markdown.

    python benchmarks/families.py

256 lanes of the benchmark scene start at the strip's edge at random times of its first
slide and run for four slips, one after the other in compiled scalar code, with the step
control of lanes. Error: in periods at the end, median and 99%, against Radau IIA at 1e-11
(lanes that end inside a slip are in the 99%). Field evaluations count those at the ends of
steps, with derivatives. Microseconds of one core.
"""

import math
import time

import numpy as np
from numba import njit
from scalar import SLIPS, integrator, lanes, load, rate

from frictionjax.wiggly.rosenbrock.rodas4p2 import RODAS4P2
from frictionjax.wiggly.rosenbrock.rodas5p import RODAS5P
from frictionjax.wiggly.rosenbrock.step import Tableau

LANES = 256


def rosenbrock(tableau: Tableau):
    """A step of any Rosenbrock scheme with `Tableau` coefficients."""
    stages = len(tableau.times)
    a, c = (np.zeros((stages, stages)) for _ in range(2))
    for i in range(1, stages):
        a[i, :i], c[i, :i] = tableau.a[i], tableau.c[i]
    times, by_times = np.array(tableau.times), np.array(tableau.time_derivative)
    diagonal = tableau.gamma

    @njit
    def step(start, t, h, y, eps, per_drag, tolerance):
        velocity, by_state, by_time = start
        w = 1 / (1 / (h * diagonal) - by_state)
        u = np.zeros(stages)
        inside = y
        for i in range(stages):
            shift = 0.0
            inside = y
            for j in range(i):
                inside += a[i, j] * u[j]
                shift += c[i, j] * u[j]
            if i:
                velocity = rate(load(t + times[i] * h), inside, eps, per_drag)
            u[i] = (velocity + shift / h + h * by_times[i] * by_time) * w
        return inside + u[-1], u[-1], stages - 1

    return step


SERIES = tuple(1 / math.factorial(k) for k in range(18, 3, -1))


@njit
def phis(z):
    """`phi_1` to `phi_4`, with `phi_{k+1} = (phi_k - 1/k!)/z` and `phi_0 = exp`."""
    if abs(z) > 1.0:
        one = (math.exp(z) - 1) / z
        two = (one - 1) / z
        three = (two - 1 / 2) / z
        return one, two, three, (three - 1 / 6) / z
    four = 0.0
    for weight in SERIES:
        four = four * z + weight
    three = four * z + 1 / 6
    two = three * z + 1 / 2
    return two * z + 1, two, three, four


@njit
def exprb32(start, t, h, y, eps, per_drag, tolerance):
    """M. Hochbruck, A. Ostermann, J. Schweitzer, SIAM J. Numer. Anal. 47:1 (2009)."""
    velocity, by_state, by_time = start
    one, two, three, _ = phis(h * by_state)
    first = h * (one * velocity + h * two * by_time)
    slope = rate(load(t + h), y + first, eps, per_drag)
    rest = slope - velocity - by_state * first - h * by_time
    error = 2 * h * three * rest
    return y + first + error, error, 1


@njit
def exprb43(start, t, h, y, eps, per_drag, tolerance):
    """As `exprb32`, of order 4."""
    velocity, by_state, by_time = start
    one, two, _, _ = phis(0.5 * h * by_state)
    half = 0.5 * h * (one * velocity + 0.5 * h * two * by_time)
    slope = rate(load(t + 0.5 * h), y + half, eps, per_drag)
    rest2 = slope - velocity - by_state * half - 0.5 * h * by_time
    one, two, three, four = phis(h * by_state)
    first = h * (one * velocity + h * two * by_time)
    far = first + h * one * rest2
    slope = rate(load(t + h), y + far, eps, per_drag)
    rest3 = slope - velocity - by_state * far - h * by_time
    error = h * four * (12 * rest3 - 48 * rest2)
    return y + first + h * three * (16 * rest2 - 2 * rest3) + error, error, 2


ROOT = math.sqrt(6.0)
NODES = np.array([(4 - ROOT) / 10, (4 + ROOT) / 10, 1.0])
RADAU = np.array(
    [
        [(88 - 7 * ROOT) / 360, (296 - 169 * ROOT) / 1800, (-2 + 3 * ROOT) / 225],
        [(296 + 169 * ROOT) / 1800, (88 + 7 * ROOT) / 360, (-2 - 3 * ROOT) / 225],
        [(16 - ROOT) / 36, (16 + ROOT) / 36, 1 / 9],
    ]
)
INVERSE = np.linalg.inv(RADAU)
ESTIMATE = np.array([-13 - 7 * ROOT, -13 + 7 * ROOT, -1.0]) / 3
REAL = 3 + 3 ** (2 / 3) - 3 ** (1 / 3)
_ITERATIONS, _NEWTON = 10, 0.02  # at most; of the tolerance


@njit
def inverse(m):
    """Of a 3x3 matrix by cofactors: LAPACK's overhead would be most of a step."""
    out = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            k, n, p, q = (j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3
            out[i, j] = m[k, p] * m[n, q] - m[k, q] * m[n, p]
    return out / (m[0, 0] * out[0, 0] + m[0, 1] * out[1, 0] + m[0, 2] * out[2, 0])


@njit
def newton_change(solve, f, z, h):
    """`solve @ (f - A^-1 z/h)`, and its largest entry."""
    change, size = np.zeros(3), 0.0
    for i in range(3):
        rest = f[i]
        for j in range(3):
            rest -= INVERSE[i, j] * z[j] / h
        for j in range(3):
            change[j] += solve[j, i] * rest
    for i in range(3):
        size = max(size, abs(change[i]))
    return change, size


@njit
def radau(start, t, h, y, eps, per_drag, tolerance):
    """Radau IIA of order 5, simplified Newton from zero, E. Hairer and G. Wanner IV.8."""
    velocity, by_state, _ = start
    solve = inverse(INVERSE / h - by_state * np.eye(3))
    z, f = np.zeros(3), np.zeros(3)
    pulls = np.array([load(t + NODES[0] * h), load(t + NODES[1] * h), load(t + h)])
    before = np.inf
    for iteration in range(1, _ITERATIONS + 1):
        for i in range(3):
            f[i] = rate(pulls[i], y + z[i], eps, per_drag)
        change, size = newton_change(solve, f, z, h)
        z += change
        share = size / before if iteration > 1 else 0.0
        done = size <= 1e-3 * _NEWTON * tolerance
        if iteration > 1 and share < 1:
            done = done or share / (1 - share) * size <= _NEWTON * tolerance
        if done:
            bend = ESTIMATE[0] * z[0] + ESTIMATE[1] * z[1] + ESTIMATE[2] * z[2]
            filtered = velocity + bend / h
            return y + z[2], filtered / (REAL / h - by_state), 3 * iteration
        if share >= 1 or not size < 1e3:
            break
        before = size
    return np.inf, np.inf, 3 * iteration


METHODS = {
    "Rodas4P2": integrator(rosenbrock(RODAS4P2), 4),
    "Rodas5P": integrator(rosenbrock(RODAS5P), 5),
    "exprb32": integrator(exprb32, 3),
    "exprb43": integrator(exprb43, 4),
    "Radau IIA 5": integrator(radau, 4),
}
CASES = ((0.5, 1e-3), (1.0, 1e-2), (1.0, 1e-4), (2.0, 1e-3))
_COLUMNS = (
    "gamma | eps | method | tolerance | steps/slip | rejected | evaluations/slip | "
    "median error | 99% error | us/slip"
)


def row(case: tuple[float, float], name: str, tolerance: float, exact: np.ndarray) -> None:
    gamma, eps = case
    numbers = *lanes(eps, LANES), eps, eps ** -(1 + gamma), tolerance
    seconds = []
    for _ in range(4):
        begin = time.process_time()
        y, (steps, rejected, evaluations) = METHODS[name](*numbers)
        seconds.append(time.process_time() - begin)
    slips = LANES * SLIPS
    error = np.sort(np.abs(y - exact))
    print(
        f"| {gamma:g} | {eps:g} | {name} | {tolerance:g} | {steps / slips:.0f} | "
        f"{rejected / steps:.0%} | {evaluations / slips:.0f} | {np.median(error):.1e} | "
        f"{error[int(0.99 * LANES)]:.1e} | {1e6 * min(seconds[1:]) / slips:.1f} |",
        flush=True,
    )


def main() -> None:
    print(f"| {_COLUMNS} |\n{'|---' * 10}|")
    for gamma, eps in CASES:
        numbers = *lanes(eps, LANES), eps, eps ** -(1 + gamma)
        exact, _ = METHODS["Radau IIA 5"](*numbers, 1e-11)
        for name in METHODS:
            for tolerance in (1e-3, 1e-4, 1e-5):
                row((gamma, eps), name, tolerance, exact)


if __name__ == "__main__":
    main()
