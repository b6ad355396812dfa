"""Predicted against measured: time of each cell of the benchmark sweep alone.

    python benchmarks/cost_model.py [--accuracy 1e-3] [--again]

For both benchmark scenes: 16 eps from 1e-1 to 1e-4 x gamma 0.5, 1, 2, each cell by itself,
warm, the faster of two runs; then the whole sweep. At the end loads of many periods, fast
turns and jumps, which the model is not fitted to.
"""

import argparse
import time

import jax
import numpy as np
from scenes import NAMES, scene

import frictionjax as fx
from frictionjax.cost.machine_cost import machine_cost

fx.use_fast_cpu()
jax.config.update("jax_enable_x64", True)
fx.keep_compiled()

EPS, GAMMA = np.geomspace(1e-1, 1e-4, 16), (0.5, 1.0, 2.0)
OTHERS = {
    "10 periods": (fx.loads.Sine(1.0488, 3.0), 30.0),
    "30 periods": (fx.loads.Sine(1.0488, 3.0), 90.0),
    "30 turns in 1.5 s": (fx.loads.Triangle(1.0488, 0.1), 1.5),
    "jumps": (
        fx.loads.PiecewiseLinear(
            [0.0, 1.0, 1.001, 2.0, 2.001, 3.0], [0.0, 0.0, 1.0, 1.0, -1.0, -1.0]
        ),
        3.0,
    ),
}
FEW = (1e-2, 1e-3, 1e-4)


def clocked(scene, eps, gamma, ts, accuracy):
    """Seconds of the faster of two warm runs."""
    spent = []
    for _ in range(3):
        begun = time.perf_counter()
        fx.sweep(scene, eps, gamma, ts, accuracy)
        spent.append(time.perf_counter() - begun)
    return min(spent[1:])


def other_loads(accuracy: float) -> None:
    """The vertical scene under loads of another kind."""
    print("\nother loads, vertical, measured over predicted (measured, s)\n")
    print("| load | gamma | " + " | ".join(f"{e:.0e}" for e in FEW) + " |")
    print("|" + "---|" * (2 + len(FEW)))
    parts = scene("vertical")
    for name, (load, duration) in OTHERS.items():
        fixed = parts.profile, parts.bristle, parts.support
        one, ts = fx.Scene(*fixed, load, duration), np.linspace(0, duration, 61)
        for gamma in GAMMA[:2]:
            cost = fx.predict_cost(one, FEW, gamma, accuracy, ts)
            found = np.array([clocked(one, e, gamma, ts, accuracy) for e in FEW])
            pairs = zip(found / cost.cells[0], found, strict=True)
            cells = " | ".join(f"{ratio:.2f} ({spent:.2g})" for ratio, spent in pairs)
            print(f"| {name} | {gamma:g} | {cells} |", flush=True)


def main() -> None:
    """Print how far predictions are off."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--accuracy", type=float, default=1e-3)
    parser.add_argument("--again", action="store_true", help="Measure the machine again.")
    options = parser.parse_args()
    machine = machine_cost(again=options.again)
    print(machine)
    every = []
    for name in NAMES:
        one = scene(name)
        ts = np.linspace(0, float(one.duration), 61)
        cost = fx.predict_cost(one, EPS, GAMMA, options.accuracy, ts)
        print(f"\n{name}, measured over predicted\n")
        print("| gamma | " + " | ".join(f"{e:.0e}" for e in EPS[::3]) + " |")
        print("|" + "---|" * (1 + EPS[::3].size))
        for row, gamma in zip(cost.cells, GAMMA, strict=True):
            found = [clocked(one, e, gamma, ts, options.accuracy) for e in EPS]
            ratios = np.array(found) / row
            every.append(ratios)
            print(f"| {gamma:g} | " + " | ".join(f"{r:.2f}" for r in ratios[::3]) + " |")
        whole = clocked(one, EPS, GAMMA, ts, options.accuracy)
        print(f"\nthe whole sweep: {whole:.2f} s, predicted {cost.seconds:.2f}")
    off = np.maximum(np.concatenate(every), 1 / np.concatenate(every))
    print(
        f"\n{off.size} cells: {np.mean(off <= 2):.0%} within a factor of 2, "
        f"median {np.median(off):.2f}, worst {off.max():.2f}"
    )
    other_loads(options.accuracy)


if __name__ == "__main__":
    main()
