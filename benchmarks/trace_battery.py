"""Random surfaces and levels of noise: where fits to traces end, and how far off.

`python benchmarks/trace_battery.py [noise ...]` prints Markdown. 8 surfaces of 4 or 6
harmonics with slopes up to 0.44, 201 samples of a loop of 10 s. `pull`: largest error of a
slope that counts as determined, in standard errors.
"""

import sys
import time

import jax
import numpy as np

import frictionjax as fx

jax.config.update("jax_enable_x64", True)

BRISTLE = fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.5)
LOOP = fx.loads.PiecewiseLinear([0.0, 2.5, 7.5, 10.0], [0.0, 0.8, -0.8, 0.0])
TIMES = 0.0137 + np.linspace(0, 9.98, 201)
EPS, SEEDS, NOISES = 0.05, range(1, 9), (0.0, 1e-4, 3e-4, 1e-3)
WRONG = 4.0  # standard errors


def surface(seed):
    harmonics = 6 if seed % 2 else 4
    rng, n = np.random.default_rng(seed), np.arange(1, harmonics + 1)
    return fx.profiles.Fourier(*(0.02 * rng.normal(size=(2, harmonics)) / n**2.5))


def slopes(profile, phases):
    return np.asarray(jax.vmap(jax.grad(profile))(phases))


def trial(seed, noise):
    """Status, share determined, largest error and pull, trajectories, CPU seconds."""
    truth = surface(seed)
    scene = fx.Scene(truth, BRISTLE, fx.supports.Spring(1.0), LOOP, 10.0)
    trace = fx.simulate_trace(scene, EPS, 1.0, TIMES, noise=noise, seed=seed)
    before = time.process_time()
    fit = fx.fit_trace(trace, scene, EPS, 1.0, harmonics=truth.cos.shape[0])
    seconds = time.process_time() - before
    seen = fit.identifiability
    error = np.abs(seen.slope - slopes(truth, seen.phases))
    pull = np.max((error / seen.standard_error)[seen.determined], initial=0)
    worst = np.max(error[seen.determined], initial=0) / (0.5 * np.ptp(seen.slope))
    return fit, seen.share, worst, pull, seconds


def main(noises):
    print(
        "| noise (N) | surface | steepest | status | chi2 | determined | error | pull |",
        end="",
    )
    print(" steps | CPU s |\n|---|---|---|---|---|---|---|---|---|---|")
    counts = []
    for noise in noises:
        right = flagged = wrong = 0
        for seed in SEEDS:
            fit, share, worst, pull, seconds = trial(seed, noise)
            steep = np.max(np.abs(slopes(surface(seed), np.arange(512) / 512)))
            right += fit.success and pull < WRONG
            flagged += not fit.success
            wrong += fit.success and pull >= WRONG
            print(
                f"| {noise:g} | {seed} | {steep:.2f} | {fit.status.name} | "
                f"{fit.reduced_chi2:.2g} | {share:.0%} | {worst:.1e} | {pull:.2g} | "
                f"{fit.history.chi2.size} | {seconds:.0f} |",
                flush=True,
            )
        counts.append(f"| {noise:g} | {right} | {flagged} | {wrong} |")
    print(f"\n| noise (N) | FITTED, pull < {WRONG:g} | told otherwise | FITTED, wrong |")
    print("\n".join(["|---|---|---|---|", *counts]))


if __name__ == "__main__":
    main([float(v) for v in sys.argv[1:]] or NOISES)
