"""Is `accuracy` honest? Error reached over accuracy asked for, over the whole grid.

python benchmarks/calibration.py [--method auto] [--bristles vertical angular]
    [--smallest 1e-7] [--largest 1] [--gamma 0.5 1] [--truth 1e-8 1e-9]

For each bristle and load: eps 1e-1 to 1e-6, gamma 0.5 to 2, accuracy 1e-1 to 1e-6. The
error is the larger of the largest error of z outside slips, in eps, at 61 times, and that
of the dissipation, relative. Truth: every slip at accuracy 1e-8 where eps >= 1e-4, windows
at 1e-8 below (or the first of `--truth`); its distance from the same at 1e-9 (the second)
is its own error, and a ratio is only counted where that is below a third of the accuracy
asked for. (Tests compare with LSODA.)
"""

import argparse

import jax
import numpy as np

import frictionjax as fx
from frictionjax.instants import instants
from frictionjax.wiggly.status import status_of

fx.use_fast_cpu()
jax.config.update("jax_enable_x64", True)

EPS = np.geomspace(1e-1, 1e-6, 6) * 0.97
GAMMA = np.array([0.5, 0.75, 1.0, 1.5, 2.0])
ACCURACIES = 10.0 ** -np.arange(1, 7)
TIMES = np.linspace(0, 3, 61)
EVERY_SLIP = 9e-5  # the smallest eps of references that integrate every slip
FOUR = fx.profiles.Fourier([0.004, -0.002, 0.0, 0.0005], [0.008, 0.003, -0.001, 0.0])
SINE = fx.profiles.Sine(0.1)
BRISTLES = {
    "homothetic": (FOUR, fx.bristles.Homothetic(1.0)),
    "vertical": (SINE, fx.bristles.VerticalSpring(1.0, 2.0, 1.0)),
    "slanted": (FOUR, fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.6)),
    "angular": (FOUR, fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2)),
}
LOADS = {"sine": fx.loads.Sine(1.0488, 3.0), "triangle": fx.loads.Triangle(1.0488, 3.0)}


def solved(scene, eps, gamma, when, accuracy, method):
    """States and dissipation at the instants and around them, over gamma."""
    ts, back = when.around(float(scene.duration))
    data = fx.sweep(scene, eps, gamma, ts, accuracy, method)
    z = data.z.values[:, 0][:, back]
    spent = data.dissipation.values[:, 0][:, back[1]]
    return z, spent, data.status.values[:, 0]


def gap(z, spent, true_z, true_spent, counted, eps):
    """The larger of both errors, over gamma."""
    off = np.where(counted, np.abs(z - true_z) / eps, 0.0).max(axis=1)
    last = np.abs(true_spent[:, -1:])
    return np.maximum(off, (np.abs(spent - true_spent) / last).max(axis=1))


def cells(scene, eps, gamma, method, truths):
    """Rows gamma, accuracy, ratio, error of the truth over the accuracy, status."""
    when = instants(scene, eps, TIMES)
    way = "resolved" if eps >= EVERY_SLIP else "windowed"
    z, spent, _ = solved(scene, eps, gamma, when, truths[0], way)
    counted = ~when.in_slip(z, eps, float(scene.duration))
    keep = np.zeros(when.ts.size, dtype=bool)
    keep[when.asked] = True
    counted &= keep
    other, other_spent, _ = solved(scene, eps, gamma, when, truths[1], way)
    known = gap(other[:, 1], other_spent, z[:, 1], spent, counted, eps)
    for accuracy in ACCURACIES:
        found, lost, status = solved(scene, eps, gamma, when, accuracy, method)
        error = gap(found[:, 1], lost, z[:, 1], spent, counted, eps)
        for row in zip(gamma, error / accuracy, known / accuracy, status, strict=True):
            yield row[0], accuracy, *row[1:]


def report(rows):
    """Share of the cells below 1 and above 3, and the worst by accuracy and gamma."""
    ok = rows[:, 5] == 0
    known = rows[:, 4] < 1 / 3
    count = ok & known
    ratio = rows[count, 3]
    print(
        f"{len(rows)} cells; status not OK: {np.sum(~ok)}; truth too rough: "
        f"{np.sum(ok & ~known)}; of the other {count.sum()}: below 1: "
        f"{np.mean(ratio < 1):.2%}, above 3: {np.sum(ratio > 3)}, worst {ratio.max():.3g}"
    )
    print("\nlargest error over accuracy (cells that count)\n")
    print("| gamma | " + " | ".join(f"{a:.0e}" for a in ACCURACIES) + " |")
    print("|" + "---|" * (1 + ACCURACIES.size))
    for gamma in np.unique(rows[:, 1]):
        line = []
        for accuracy in ACCURACIES:
            some = rows[count & (rows[:, 1] == gamma) & (rows[:, 2] == accuracy), 3]
            line.append(f"{some.max():.2g} ({some.size})" if some.size else "-")
        print(f"| {gamma:g} | " + " | ".join(line) + " |")


def main():
    """Print offending cells as they come, and the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--method", default="auto")
    parser.add_argument("--bristles", nargs="+", default=list(BRISTLES))
    parser.add_argument("--loads", nargs="+", default=list(LOADS))
    parser.add_argument("--smallest", type=float, default=1e-7)
    parser.add_argument("--largest", type=float, default=1.0)
    parser.add_argument("--gamma", type=float, nargs="+", default=list(GAMMA))
    parser.add_argument("--truth", type=float, nargs=2, default=[1e-8, 1e-9])
    options = parser.parse_args()
    rows = []
    for name in options.bristles:
        for load in options.loads:
            surface, bristle = BRISTLES[name]
            scene = fx.Scene(surface, bristle, fx.supports.Spring(1.0), LOADS[load], 3.0)
            for eps in EPS[(options.smallest < EPS) & (options.largest >= EPS)]:
                fixed = float(eps), np.array(options.gamma), options.method, options.truth
                for gamma, accuracy, ratio, known, status in cells(scene, *fixed):
                    rows.append((eps, gamma, accuracy, ratio, known, status))
                    if status or not ratio < 1:
                        cell = f"{name} {load} eps={eps:.2g} gamma={gamma:g}"
                        word = status_of(int(status)).name
                        asked = f"accuracy={accuracy:.0e}: {ratio:.3g} of it"
                        print(cell, asked, f"truth {known:.1g} {word}", flush=True)
    report(np.array(rows, dtype=float))


if __name__ == "__main__":
    main()
