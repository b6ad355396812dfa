"""The benchmark scene in compiled scalar code: its field, and step control as in lanes."""

import math

import numpy as np
from numba import njit
from scenes import AMPLITUDE, PERIOD, SLOPE, TWO_PI

REACH = 0.125  # periods, a quarter of a falling branch
SLIPS = 4


@njit(inline="always")
def load(t):
    return AMPLITUDE * math.sin(TWO_PI / PERIOD * t)


@njit(inline="always")
def rate(pull, y, eps, per_drag):
    phase = TWO_PI * y
    normal = 1.0 + eps * (SLOPE / TWO_PI) * math.sin(phase)
    return (pull - eps * y - SLOPE * math.cos(phase) * normal) * per_drag


@njit(inline="always")
def point(t, y, eps, per_drag):
    """Velocity and its derivatives by state and time."""
    phase = TWO_PI * y
    s, c = math.sin(phase), math.cos(phase)
    normal = 1.0 + eps * (SLOPE / TWO_PI) * s
    velocity = (load(t) - eps * y - SLOPE * c * normal) * per_drag
    bend = SLOPE * (TWO_PI * s * normal - eps * SLOPE * c * c)
    by_time = AMPLITUDE * TWO_PI / PERIOD * math.cos(TWO_PI / PERIOD * t)
    return velocity, (bend - eps) * per_drag, by_time * per_drag


def integrator(step, order: int):
    """Compile a loop over lanes around `step`, whose error estimate is O(h^order).

    `step(start, t, h, y, eps, per_drag, tolerance)` gives the new state, the estimate and
    how often it has evaluated the field, beside the one at the start.
    """

    @njit
    def one(start, end, y, eps, per_drag, tolerance):
        t, level, trend = 0.0, 0.0, 0.0
        steps, rejected, evaluations = 0, 0, 1
        first = 1e-2 / per_drag
        here = point(start, y, eps, per_drag)
        while t < end - start:
            full, left = first * math.exp2(level / 8), end - start - t
            cut = full >= left
            h = left if cut else full
            new, error, more = step(here, start + t, h, y, eps, per_drag, tolerance)
            excess, share = abs(new - y) / REACH, abs(error) / tolerance
            if not (excess < 20.0 and share < 1e300):
                excess, share = 20.0, 1.0
            share = math.log2(max(share, 1e-5, excess**order)) / order
            size = math.log2(h / first)
            change = math.log2(0.9) - 0.8 * share
            accepted = share <= 0
            if accepted:
                change = min(change + 0.2, change - share + trend + size)
            most = math.log2(8.0) if accepted else -0.125
            change = min(max(change, math.log2(0.1)), most)
            after = math.floor(8 * (size + change) + 1e-4)
            steps += 1
            evaluations += more
            if accepted:
                trend = trend if cut else share - size
                level = max(after, level) if cut else after
                y, t = new, t + h
                here = point(start + t, y, eps, per_drag)
                evaluations += 1
            else:
                rejected += 1
                level = after
        return y, steps, rejected, evaluations

    @njit
    def every(starts, ends, wells, eps, per_drag, tolerance):
        y = np.empty_like(starts)
        counts = np.zeros(3)
        for i in range(starts.size):
            found = one(starts[i], ends[i], wells[i], eps, per_drag, tolerance)
            y[i] = found[0]
            counts += np.array([found[1], found[2], found[3]])
        return y, counts

    return every


def lanes(eps: float, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Random times in the first slide, four slips later, and wells of the strip's edge."""
    start = np.random.default_rng(0).uniform(0.1, 0.5, count)
    edge = AMPLITUDE * np.sin(TWO_PI * start / PERIOD) - SLOPE
    end = np.arcsin((edge + SLIPS * eps + SLOPE) / AMPLITUDE) * PERIOD / TWO_PI
    return start, end, np.ceil(edge / eps)
