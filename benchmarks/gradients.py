"""Derivatives of trajectories through more and more slips.

`python benchmarks/gradients.py [trace|solve]` prints Markdown. `trace`: derivatives of z at
the samples of `fit_trace`, forward mode, against a variational equation of its own
(variation.py) and against central differences. `solve`: `jax.jacrev` through `fx.solve` on
1000 slips of a ramp against central differences.
"""

import sys
import time

import jax
import jax.numpy as jnp
import numpy as np
from design_trace import PERIOD, SAMPLES, scene_of, surface
from variation import slanted_variation

import frictionjax as fx
from frictionjax.design.trace.flow import flow, plan_of

jax.config.update("jax_enable_x64", True)

SLANTED = (1.0, 2.2, 1.0, 0.5)  # the bristle of design_trace
CASES = ((0.1, 1, 1e-9), (0.03, 1, 1e-9), (0.03, 8, 1e-7))
CHECKED = (0, 5, 9)
TIGHT = 1e-13

# At 1e-9 the derivative of the dissipation by the rate, a thousandth of value over number,
# is 6e-5 off.
EPS, SLIPS, ACCURACY = 1e-3, 1000, 1e-10
NAMES = ("slope", "stiffness", "angle", "support", "rate", "z0", "eps", "gamma")
POINT = jnp.array([0.1, 1.0, 0.4, 1.0, 1.0, 0.0, EPS, 1.0])
# Steps of the differences. A slip is 1e-3 of load: steps that shift slips by more than a
# hundredth of that have errors of their own.
STEPS = (1e-6, 1e-5, 1e-5, 1e-5, 2e-5, 1e-6, 1e-9, 1e-5)


def central(run, numbers, index, step):
    """Of order 4."""
    ends = []
    for share in (1, -1, 2, -2):
        moved = np.array(numbers)
        moved[index] += share * step
        ends.append(np.asarray(run(moved)))
    return (8 * (ends[0] - ends[1]) - (ends[2] - ends[3])) / (12 * step)


def traces():
    print("| wells passed | accuracy | against LSODA | LSODA's own | differences | s |")
    print("|---|---|---|---|---|---|")
    for case in CASES:
        print(trace_row(*case), flush=True)


def trace_row(eps, turns, accuracy):
    numbers = np.concatenate([surface(1).cos, surface(1).sin])
    scene = scene_of(surface(1), turns)
    ts = np.linspace(0, float(scene.duration), SAMPLES + 2)[1:-1]
    known = scene, np.asarray(eps), np.asarray(1.0)
    plan = plan_of(numbers, *known, np.asarray(accuracy))
    found = jax.block_until_ready(flow(numbers, *known, ts, plan))
    before = time.perf_counter()
    jax.block_until_ready(flow(numbers, *known, ts, plan))
    seconds = time.perf_counter() - before
    assert np.all(np.isfinite(found.by))
    rest = np.abs(np.asarray(found.speed)) < 10 * 4 / PERIOD
    kinks, loads = np.asarray(scene.load.times), np.asarray(scene.load.values)

    def judged(index, tolerance):
        parts = numbers, SLANTED, eps, kinks, loads, ts, index
        return slanted_variation(*parts, tolerance)[1]

    def gap(by, exact):
        return np.max(np.abs(by - exact)[rest]) / np.max(np.abs(exact[rest]))

    exact = {index: judged(index, TIGHT) for index in CHECKED}
    ours = max(gap(np.asarray(found.by)[i], exact[i]) for i in CHECKED)
    own = max(gap(judged(i, 100 * TIGHT), exact[i]) for i in CHECKED)
    middle = CHECKED[1]
    slope = central(lambda x: flow(x, *known, ts, plan).z, numbers, middle, 1e-7 / turns)
    theirs = gap(slope, exact[middle])
    wells = float(np.sum(np.abs(np.diff(np.asarray(found.z))))) / eps
    gaps = f"{ours:.1e} | {own:.1e} | {theirs:.1e}"
    return f"| {wells:.0f} | {accuracy:g} | {gaps} | {seconds:.1f} |"


def ramp_of(p, duration):
    return fx.Scene(
        fx.profiles.Sine(p[0]),
        fx.bristles.SlantedSpring(p[1], 2.2, 1.0, p[2]),
        fx.supports.Spring(p[3]),
        fx.loads.Ramp(p[4]),
        duration,
        p[5],
    )


def solves():
    rho = float(fx.friction(ramp_of(POINT, 1.0)).rho_plus)
    duration = rho + (SLIPS + 0.4) * EPS
    ts = np.array([duration - 10 * EPS, duration])

    @jax.jit
    def run(p):
        found = fx.solve(ramp_of(p, duration), p[6], p[7], ts, accuracy=ACCURACY)
        return jnp.concatenate([found.z, found.dissipation])

    reverse = jax.jit(jax.jacrev(run))
    values = np.asarray(run(POINT))
    jax.block_until_ready(reverse(POINT))
    before = time.perf_counter()
    jacobian = np.asarray(reverse(POINT))
    seconds = time.perf_counter() - before
    print(f"\n{SLIPS} slips, all derivatives of four numbers in {seconds:.1f} s:\n")
    print("| by | z at the end | gap | dissipation at the end | gap |")
    print("|---|---|---|---|---|")
    for index, name in enumerate(NAMES):
        size = max(abs(float(POINT[index])), EPS)
        near = central(run, POINT, index, STEPS[index])
        cells = []
        for row in (1, 3):
            # Derivatives far below value over number are rounding of the differences.
            scale = max(abs(near[row]), 1e-3 * abs(values[row]) / size)
            gap = abs(jacobian[row, index] - near[row]) / scale
            cells.append(f"{jacobian[row, index]:.9g} | {gap:.1e}")
        print(f"| {name} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    if "solve" not in sys.argv:
        traces()
    if "trace" not in sys.argv:
        solves()
