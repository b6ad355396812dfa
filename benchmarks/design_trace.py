"""Fits to traces: errors against noise, eps and gamma, seconds, and gradients.

`python benchmarks/design_trace.py [gradients]` prints Markdown.
"""

import sys
import time

import jax
import numpy as np

import frictionjax as fx
from frictionjax.design.trace_flow import flow, plan_of

jax.config.update("jax_enable_x64", True)

BRISTLE = fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.5)
PERIOD, SAMPLES, HARMONICS = 20.0, 301, 8
CASES = [
    (0.05, 1.0, 0.0),
    (0.05, 1.0, 1e-4),
    (0.05, 1.0, 1e-3),
    (0.05, 2.0, 1e-4),
    (0.02, 1.0, 1e-4),
]


def surface(seed):
    """A random surface of 8 harmonics."""
    rng, n = np.random.default_rng(seed), np.arange(1, HARMONICS + 1)
    waves = 0.02 * rng.normal(size=(2, HARMONICS)) / n**2.5
    return fx.profiles.Fourier(*waves)


def scene_of(profile, turns=1):
    """A load up and down `turns` times."""
    quarter = PERIOD / 4
    times = np.concatenate(
        [[0.0], quarter * (1 + 2 * np.arange(2 * turns)), [4 * quarter * turns]]
    )
    values = np.concatenate([[0.0], (-1.0) ** np.arange(2 * turns), [0.0]])
    load = fx.loads.PiecewiseLinear(times, values)
    return fx.Scene(profile, BRISTLE, fx.supports.Spring(1.0), load, times[-1])


def recovery(seeds=(1, 2, 3)):
    """One row a case and surface."""
    print(
        "| eps (m) | gamma | noise (N) | surface | status | determined | error | pull | s |"
    )
    print("|---|---|---|---|---|---|---|---|---|")
    for eps, gamma, noise in CASES:
        for seed in seeds:
            profile = surface(seed)
            scene = scene_of(profile)
            ts = np.linspace(0, PERIOD, SAMPLES + 2)[1:-1]
            trace = fx.simulate_trace(scene, eps, gamma, ts, noise=noise, seed=seed)
            before = time.perf_counter()
            fit = fx.fit_trace(trace, scene, eps, gamma)
            seconds = time.perf_counter() - before
            seen = fit.identifiability
            error = np.abs(
                seen.slope - np.asarray(jax.vmap(jax.grad(profile))(seen.phases))
            )
            chosen = seen.determined
            worst = np.max(error[chosen], initial=0) / (0.5 * np.ptp(seen.slope))
            pull = np.max((error / seen.standard_error)[chosen], initial=0)
            print(
                f"| {eps} | {gamma} | {noise:g} | {seed} | {fit.status.name} | "
                f"{seen.share:.0%} | {worst:.1e} | {pull:.2g} | {seconds:.1f} |",
                flush=True,
            )


def gradients():
    """Forward mode against central differences of order 4, through more and more slips."""
    print("| wells passed | samples | largest relative error | s, all 16 derivatives |")
    print("|---|---|---|---|")
    profile = surface(1)
    numbers = np.concatenate([profile.cos, profile.sin])
    for eps, turns in ((0.1, 1), (0.03, 1), (0.03, 8)):
        scene = scene_of(profile, turns)
        end = float(scene.duration)
        ts = np.linspace(0, end, SAMPLES + 2)[1:-1]
        known = scene, np.asarray(eps), np.asarray(1.0)
        plan = plan_of(numbers, *known, np.asarray(1e-9 if turns == 1 else 1e-7))
        found = flow(numbers, *known, ts, plan)
        before = time.perf_counter()
        jax.block_until_ready(flow(numbers, *known, ts, plan))
        seconds = time.perf_counter() - before
        worst, step = 0.0, 1e-7 / turns
        rest = np.abs(np.asarray(found.speed)) < 10 * 4 / PERIOD
        for index in (0, 5, 9) if turns == 1 else (5,):
            ends = []
            for share in (1, -1, 2, -2):
                moved = numbers.copy()
                moved[index] += share * step
                ends.append(np.asarray(flow(moved, *known, ts, plan).z))
            slope = (8 * (ends[0] - ends[1]) - (ends[2] - ends[3])) / (12 * step)
            gap = np.abs(np.asarray(found.by)[index] - slope)[rest]
            worst = max(worst, float(np.max(gap) / np.max(np.abs(slope[rest]))))
        wells = float(np.sum(np.abs(np.diff(np.asarray(found.z))))) / eps
        print(f"| {wells:.0f} | {ts.size} | {worst:.1e} | {seconds:.2f} |", flush=True)


if __name__ == "__main__":
    if "gradients" not in sys.argv:
        recovery()
        print()
    gradients()
