"""One step of one of 64 lanes against the same step in compiled scalar code, one core each.

    python benchmarks/lane_step.py

Rodas4P2 on the benchmark scene at eps = 1e-3, gamma = 1. `bare`: the six stages and the
field with its derivatives at the end, with steps of 1 us. `whole`: four slips with step
control and, for lanes, everything that they do beside (queue, guides, extents). Scalar
code: numba without fast math, one sine and one cosine a stage, derivatives in closed form.
The process keeps to one core and seconds are those it has had of it. Positions of both are
compared at the end.
"""

import os
import time

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from numba import njit
from scalar import REACH, SLIPS, integrator, lanes, load, point, rate
from scenes import AMPLITUDE, EDGES, PERIOD, SLOPE, TWO_PI, scene

import frictionjax as fx
from frictionjax.wiggly.equation.field import TipField
from frictionjax.wiggly.lanes.lane import LaneCells, LaneScene
from frictionjax.wiggly.lanes.loops import march
from frictionjax.wiggly.lanes.queue import Lanes, Segments
from frictionjax.wiggly.lanes.settings import SETTINGS
from frictionjax.wiggly.rosenbrock.rodas4p2 import RODAS4P2
from frictionjax.wiggly.rosenbrock.step import Linearised, rosenbrock_step

# Before JAX starts its threads, which it does with the first computation.
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
fx.use_fast_cpu()
jax.config.update("jax_enable_x64", True)

EPS, GAMMA, STEP, COUNT = 1e-3, 1.0, 1e-6, 10_000
TOLERANCE, LANES = 1e-4, 2048
DRAG = EPS ** (1 + GAMMA)
REPEATS = 15

SCHEME = RODAS4P2
(A1,), (A2, B2), (A3, B3, C3), (A4, B4, C4, D4) = SCHEME.a[1:5]
(P1,), (P2, Q2), (P3, Q3, R3), (P4, Q4, R4, S4), (P5, Q5, R5, S5, T5) = SCHEME.c[1:]
TIME1, TIME2, TIME3 = SCHEME.times[1:4]
DT0, DT1, DT2, DT3 = SCHEME.time_derivative[:4]
DIAGONAL = SCHEME.gamma


@njit(inline="always")
def scalar_step(start, t, h, y, eps, per_drag, tolerance):
    """Rodas4P2 written out: the new state, its error estimate, evaluations."""
    velocity, by_state, by_time = start
    w = 1 / (1 / (h * DIAGONAL) - by_state)
    v = 1 / h
    u0 = (velocity + h * DT0 * by_time) * w
    f = rate(load(t + TIME1 * h), y + A1 * u0, eps, per_drag)
    u1 = (f + P1 * u0 * v + h * DT1 * by_time) * w
    f = rate(load(t + TIME2 * h), y + A2 * u0 + B2 * u1, eps, per_drag)
    u2 = (f + (P2 * u0 + Q2 * u1) * v + h * DT2 * by_time) * w
    f = rate(load(t + TIME3 * h), y + A3 * u0 + B3 * u1 + C3 * u2, eps, per_drag)
    u3 = (f + (P3 * u0 + Q3 * u1 + R3 * u2) * v + h * DT3 * by_time) * w
    pull = load(t + h)
    inside = y + A4 * u0 + B4 * u1 + C4 * u2 + D4 * u3
    f = rate(pull, inside, eps, per_drag)
    u4 = (f + (P4 * u0 + Q4 * u1 + R4 * u2 + S4 * u3) * v) * w
    inside += u4
    f = rate(pull, inside, eps, per_drag)
    u5 = (f + (P5 * u0 + Q5 * u1 + R5 * u2 + S5 * u3 + T5 * u4) * v) * w
    return inside + u5, u5, 5


@njit
def scalar_bare(t, y, count):
    per_drag = 1 / DRAG
    here = point(t, y, EPS, per_drag)
    for _ in range(count):
        y, _, _ = scalar_step(here, t, STEP, y, EPS, per_drag, 0.0)
        t += STEP
        here = point(t, y, EPS, per_drag)
    return y


scalar_whole = integrator(scalar_step, SCHEME.order)


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


def bare() -> None:
    one = scene("vertical")
    field = TipField(one.potential, one.support, one.load, EPS, EPS**GAMMA)
    t, _, y = lanes(EPS, SETTINGS.width)
    times, tips = jnp.asarray(t), jnp.asarray(y)
    wide, seconds = best(lambda: np.asarray(lanes_bare(field, times, tips)))
    _, scalar = best(lambda: scalar_bare(t[0], y[0], COUNT))
    every = np.array([scalar_bare(a, b, COUNT) for a, b in zip(t, y, strict=True)])
    show(
        "bare", seconds / COUNT / SETTINGS.width, scalar / COUNT, np.abs(wide - every).max()
    )


def whole() -> None:
    one, (start, end, well) = scene("vertical"), lanes(EPS, LANES)
    parts = LaneScene(one.potential, one.support, one.load, *EDGES)
    numbers = EPS, EPS**GAMMA, 1e-2 * DRAG, TOLERANCE, TOLERANCE, np.inf, REACH
    cells = LaneCells(*(np.array([v]) for v in numbers))
    index, ones = np.arange(LANES), np.ones(LANES)
    jobs = Lanes(0 * index, start, well, 0 * ones, index, index + 1)
    edge = AMPLITUDE * np.sin(TWO_PI * start / PERIOD) - SLOPE
    ends = edge, edge + SLIPS * EPS, 2 * ones, 2 * ones
    legs = Segments(start, end, *ends, friction=SLOPE * ones, budget=1e6 * ones)
    found, seconds = best(lambda: march(parts, cells, jobs, legs, SCHEME, True))
    steps = found.steps.sum()
    scalar = best(lambda: scalar_whole(start, end, well, EPS, 1 / DRAG, TOLERANCE))
    (y, (scalar_steps, *_)), scalar_seconds = scalar
    apart = np.median(np.abs(found.well + found.tip - y))
    show("whole", seconds / steps, scalar_seconds / scalar_steps, apart)
    per_slip = [count / LANES / SLIPS for count in (steps, scalar_steps)]
    print(f"\nsteps a slip: {per_slip[0]:.1f} and {per_slip[1]:.1f}")


def show(name: str, lane: float, scalar: float, apart: float) -> None:
    numbers = f"{1e9 * lane:.0f} | {1e9 * scalar:.0f} | {lane / scalar:.2f} | {apart:.0e}"
    print(f"| {name} | {numbers} |", flush=True)


def main() -> None:
    print(
        "| step | lane, ns | scalar, ns | ratio | apart, periods |\n|---|---|---|---|---|"
    )
    bare()
    whole()


if __name__ == "__main__":
    main()
