"""One step of one of 64 lanes against the same step in compiled scalar code, one core each.

    python benchmarks/lane_step.py

Rodas4P2 on the benchmark scene at eps = 1e-3, gamma = 1. `bare`: the six stages and the
field with its derivatives at the end, with steps of 1 us. `whole`: four slips with step
control and, for lanes, everything that they do beside (queue, guides, extents). Scalar
code: numba without fast math, one sine and one cosine a stage, derivatives in closed form.
The process keeps to one core. Positions of both are compared at the end.
"""

import math
import os
import time

import numpy as np

os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})

import frictionjax as fx  # noqa: E402

fx.use_fast_cpu()

import equinox as eqx  # noqa: E402
import jax  # noqa: E402
import jax.numpy as jnp  # noqa: E402
from numba import njit  # noqa: E402

jax.config.update("jax_enable_x64", True)

from scenes import AMPLITUDE, PERIOD, SLOPE, TWO_PI, scene  # noqa: E402

from frictionjax.wiggly.field import TipField  # noqa: E402
from frictionjax.wiggly.lanes import (  # noqa: E402
    WIDTH,
    Cells,
    Jobs,
    LaneScene,
    Legs,
    march,
)
from frictionjax.wiggly.rodas4p2 import Rodas4P2  # noqa: E402
from frictionjax.wiggly.rosenbrock import Linearised, rosenbrock_step  # noqa: E402

EPS, GAMMA, STEP, COUNT = 1e-3, 1.0, 1e-6, 10_000
TOLERANCE, REACH, SLIPS, LANES = 1e-4, 0.125, 4, 2048
DRAG = EPS ** (1 + GAMMA)
REPEATS = 15

SCHEME = Rodas4P2.tableau
(A1,), (A2, B2), (A3, B3, C3), (A4, B4, C4, D4) = SCHEME.a[1:5]
(P1,), (P2, Q2), (P3, Q3, R3), (P4, Q4, R4, S4), (P5, Q5, R5, S5, T5) = SCHEME.c[1:]
TIME1, TIME2, TIME3 = SCHEME.times[1:4]
DT0, DT1, DT2, DT3 = SCHEME.time_derivative[:4]
DIAGONAL, ORDER = SCHEME.gamma, SCHEME.order


@njit(inline="always")
def load(t):
    return AMPLITUDE * math.sin(TWO_PI / PERIOD * t)


@njit(inline="always")
def rate(pull, y):
    phase = TWO_PI * y
    normal = 1.0 + EPS * (SLOPE / TWO_PI) * math.sin(phase)
    return (pull - EPS * y - SLOPE * math.cos(phase) * normal) * (1 / DRAG)


@njit(inline="always")
def point(t, y):
    """Velocity and its derivatives by state and time."""
    phase = TWO_PI * y
    s, c = math.sin(phase), math.cos(phase)
    normal = 1.0 + EPS * (SLOPE / TWO_PI) * s
    velocity = (load(t) - EPS * y - SLOPE * c * normal) * (1 / DRAG)
    bend = SLOPE * (TWO_PI * s * normal - EPS * SLOPE * c * c)
    by_time = AMPLITUDE * TWO_PI / PERIOD * math.cos(TWO_PI / PERIOD * t)
    return velocity, (bend - EPS) * (1 / DRAG), by_time * (1 / DRAG)


@njit(inline="always")
def scalar_step(velocity, by_state, by_time, t, h, y):
    """State after a step of Rodas4P2, and its error estimate."""
    w = 1 / (1 / (h * DIAGONAL) - by_state)
    v = 1 / h
    u0 = (velocity + h * DT0 * by_time) * w
    f = rate(load(t + TIME1 * h), y + A1 * u0)
    u1 = (f + P1 * u0 * v + h * DT1 * by_time) * w
    f = rate(load(t + TIME2 * h), y + A2 * u0 + B2 * u1)
    u2 = (f + (P2 * u0 + Q2 * u1) * v + h * DT2 * by_time) * w
    f = rate(load(t + TIME3 * h), y + A3 * u0 + B3 * u1 + C3 * u2)
    u3 = (f + (P3 * u0 + Q3 * u1 + R3 * u2) * v + h * DT3 * by_time) * w
    pull = load(t + h)
    inside = y + A4 * u0 + B4 * u1 + C4 * u2 + D4 * u3
    f = rate(pull, inside)
    u4 = (f + (P4 * u0 + Q4 * u1 + R4 * u2 + S4 * u3) * v) * w
    inside += u4
    f = rate(pull, inside)
    u5 = (f + (P5 * u0 + Q5 * u1 + R5 * u2 + S5 * u3 + T5 * u4) * v) * w
    return inside + u5, u5


@njit
def scalar_bare(t, y, count):
    velocity, by_state, by_time = point(t, y)
    for _ in range(count):
        y, _ = scalar_step(velocity, by_state, by_time, t, STEP, y)
        t += STEP
        velocity, by_state, by_time = point(t, y)
    return y


@njit
def scalar_whole(start, end, y, first):
    """From start to end with the step control of lanes; the state and steps."""
    t, steps, before, level = 0.0, 0, 0.0, math.floor(8 * math.log2(first))
    velocity, by_state, by_time = point(start, y)
    while t < end - start:
        full, left = math.exp2(level / 8), end - start - t
        cut = full >= left
        h = left if cut else full
        new, error = scalar_step(velocity, by_state, by_time, start + t, h, y)
        excess = abs(new - y) / REACH
        size = math.log2(max(abs(error), 1e-5 * TOLERANCE) / TOLERANCE)
        if excess > 1:
            size = max(size, ORDER * math.log2(1.1 * excess))
        change = math.log2(0.9) - (0.7 * size - 0.4 * before) / ORDER
        accepted = size <= 0
        change = min(max(change, math.log2(0.1)), math.log2(5.0) if accepted else -0.125)
        after = math.floor(8 * (math.log2(h) + change) + 1e-4)
        steps += 1
        if accepted:
            before = before if cut else size
            level = max(after, level) if cut else after
            y, t = new, t + h
            velocity, by_state, by_time = point(start + t, y)
        else:
            level = after
    return y, steps


@njit
def scalars_whole(starts, ends, wells, first):
    y, steps = np.empty_like(starts), 0
    for i in range(starts.size):
        y[i], more = scalar_whole(starts[i], ends[i], wells[i], first)
        steps += more
    return y, steps


def best(run) -> tuple:
    """Result and least seconds of the core, which others may share."""
    seconds = []
    for _ in range(REPEATS + 1):
        begin = time.process_time()
        found = run()
        seconds.append(time.process_time() - begin)
    return found, min(seconds[1:])


@eqx.filter_jit
def lanes_bare(field: TipField, t, y):
    """COUNT steps of all lanes, as the loop of `lanes.py` makes them."""

    def step(t, y, p):
        start = Linearised(*p[:3])
        y, _ = rosenbrock_step(SCHEME, field.velocity, start, t, STEP, y)
        return t + STEP, y, field.point(t + STEP, y)

    begin = t, y, jax.vmap(field.point)(t, y)
    return jax.lax.fori_loop(0, COUNT, lambda _, c: jax.vmap(step)(*c), begin)[1]


def starts() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times in the first slide, the edge of the strip there, and four slips later."""
    start = np.random.default_rng(0).uniform(0.1, 0.5, LANES)
    edge = AMPLITUDE * np.sin(TWO_PI * start / PERIOD) - SLOPE
    end = np.arcsin((edge + SLIPS * EPS + SLOPE) / AMPLITUDE) * PERIOD / TWO_PI
    return start, edge, end


def bare() -> None:
    one, (start, edge, _) = scene("vertical"), starts()
    field = TipField(one.potential, one.support, one.load, EPS, EPS**GAMMA)
    t, y = start[:WIDTH], np.ceil(edge / EPS)[:WIDTH]
    times, tips = jnp.asarray(t), jnp.asarray(y)
    wide, seconds = best(lambda: np.asarray(lanes_bare(field, times, tips)))
    narrow, scalar = best(lambda: scalar_bare(t[0], y[0], COUNT))
    every = np.array([scalar_bare(a, b, COUNT) for a, b in zip(t, y, strict=True)])
    assert narrow == every[0]
    apart = np.abs(wide - every).max()
    show("bare", seconds / COUNT / WIDTH, scalar / COUNT, apart)


def whole() -> None:
    one, (start, edge, end) = scene("vertical"), starts()
    parts = LaneScene(one.potential, one.support, one.load)
    first, well = 1e-2 * DRAG, np.ceil(edge / EPS)
    numbers = (EPS, EPS**GAMMA, TOLERANCE, REACH, first)
    cells = Cells(*(np.array([v]) for v in numbers))
    index, ones = np.arange(LANES), np.ones(LANES)
    jobs = Jobs(0 * index, start, well, 0 * ones, index, index + 1)
    ends = edge, edge + SLIPS * EPS, 2 * ones, 2 * ones
    legs = Legs(start, end, *ends, friction=SLOPE * ones, budget=1e6 * ones)
    found, seconds = best(lambda: march(parts, cells, jobs, legs, SCHEME, balanced=False))
    steps = found.steps.sum()
    scalar, scalar_seconds = best(lambda: scalars_whole(start, end, well, first))
    y, scalar_steps = scalar
    apart = np.median(np.abs(found.well + found.tip - y))
    show("whole", seconds / steps, scalar_seconds / scalar_steps, apart)
    per_slip = steps / LANES / SLIPS, scalar_steps / LANES / SLIPS
    print(f"steps a slip: {per_slip[0]:.1f} and {per_slip[1]:.1f}")


def show(name: str, lane: float, scalar: float, apart: float) -> None:
    numbers = f"{1e9 * lane:.1f} | {1e9 * scalar:.1f} | {lane / scalar:.2f} | {apart:.0e}"
    print(f"| {name} | {numbers} |", flush=True)


def main() -> None:
    print(
        "| step | lane, ns | scalar, ns | ratio | apart, periods |\n|---|---|---|---|---|"
    )
    bare()
    whole()


if __name__ == "__main__":
    main()
