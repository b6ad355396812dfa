"""Fits to traces: errors against noise, eps and gamma, and seconds.

`python benchmarks/design_trace.py` prints Markdown. Gradients: gradients.py.
"""

import time

import jax
import numpy as np

import frictionjax as fx

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


if __name__ == "__main__":
    recovery()
