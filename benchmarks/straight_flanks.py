"""Straight flanks and flat extremes beside a sine: CPU seconds and steps of one cell.

    python benchmarks/straight_flanks.py [--surfaces sawtooth quartic] [--gamma 0.5 1]
        [--eps 1e-3 1e-4]

Prints Markdown: each surface of `tests/support/flat_folds.py` with its bristle, and a
polyline with sharp corners, beside a sine with the same one, by a warm sweep of one cell,
accuracy 1e-3: CPU seconds, thousands of steps, status where it is not OK.
"""

import argparse
import sys
import time
from pathlib import Path

import jax
import jax.numpy as jnp

import frictionjax as fx

jax.config.update("jax_enable_x64", True)
fx.use_fast_cpu()  # before the scenes, whose arrays start the compiler
sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))
from flat_folds import SCENES, SLANTED, VERTICAL, scene_of  # noqa: E402

BESIDE = {"sawtooth": SLANTED, "quartic": VERTICAL, "polyline": VERTICAL}
CORNERS = fx.profiles.Polyline([0.1, 0.4, 0.7], [0.0, 0.02, -0.01], radius=0.002)
SURFACES = SCENES | {"polyline": scene_of(CORNERS, VERTICAL)}
EPS = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)


def cell(scene: fx.Scene, eps: float, gamma: float) -> str:
    """A cell of the table."""
    fx.sweep(scene, [eps], [gamma])
    begun = time.process_time()
    found = fx.sweep(scene, [eps], [gamma])
    spent = time.process_time() - begun
    told = f"{spent:.2f} ({found.steps.item() / 1e3:.0f})"
    return told if found.status.item() == 0 else f"{told}, status {found.status.item()}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    every = list(SURFACES)
    parser.add_argument("--surfaces", nargs="+", default=every, choices=every)
    parser.add_argument("--gamma", type=float, nargs="+", default=[0.5, 0.75, 1.0, 2.0])
    parser.add_argument("--eps", type=float, nargs="+", default=EPS)
    options = parser.parse_args()
    print("| surface | gamma |", *(f"{eps:g} |" for eps in options.eps))
    print("|---|---|" + "---|" * len(options.eps))
    for name in options.surfaces:
        sine = scene_of(fx.profiles.Sine(jnp.asarray(0.1)), BESIDE[name])
        for gamma in options.gamma:
            for title, scene in ((name, SURFACES[name]), (f"sine beside {name}", sine)):
                row = (f"{cell(scene, eps, gamma)} |" for eps in options.eps)
                print(f"| {title} | {gamma:g} |", *row, flush=True)
