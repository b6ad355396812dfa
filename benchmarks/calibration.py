"""Is `accuracy` honest? Error reached over accuracy asked for, over the whole grid.

python benchmarks/calibration.py [--method auto] [--bristles vertical angular]
    [--smallest 1e-7] [--largest 1] [--gamma 0.5 1]
    [--by library|taylor] [--truth 1e-8 1e-9]

For each bristle and load: eps 1e-1 to 1e-6, gamma 0.5 to 2, accuracy 1e-1 to 1e-6. The
error is the larger of the largest error of z outside slips, in eps, at 61 times, and that
of the dissipation, relative. Truth by the library: every slip at accuracy 1e-8 where
eps >= 1e-4, windows at 1e-8 below (or the first of `--truth`); its distance from the same
at 1e-9 (the second) is its own error, and a ratio is only counted where that is below a
third of the accuracy asked for. `--by taylor`: the truth is heyoka's, through every slip,
at tolerances 1e-15 and 1e-12, for gamma up to about 1/2, and shares no line with the
library.
Below gamma = 1/2 a second table has errors of z over sup |z_eps - z| in place of eps.
"""

import argparse
from typing import Any, NamedTuple

import jax
import numpy as np
import taylor_truth

import frictionjax as fx
from frictionjax.cost.instants import Instants, instants
from frictionjax.wiggly import Status

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


class Found(NamedTuple):
    """Over gamma: states around the instants (3, n) in m, dissipation (n) in J, a status,
    and sup |z_eps - z| in m.
    """

    z: np.ndarray
    spent: np.ndarray
    status: np.ndarray
    farthest: np.ndarray


class Row(NamedTuple):
    """A cell: errors over accuracy, in eps and in sup |z_eps - z|, and the truth's own."""

    eps: float
    gamma: float
    accuracy: float
    ratio: float
    relative: float
    known: float
    status: int


class Case(NamedTuple):
    """A bristle under a load at one eps, at all gammas."""

    name: str
    load: str
    eps: float
    gamma: np.ndarray

    @property
    def scene(self) -> fx.Scene:
        surface, bristle = BRISTLES[self.name]
        return fx.Scene(surface, bristle, fx.supports.Spring(1.0), LOADS[self.load], 3.0)

    def solved(self, when: Instants, accuracy: float, method: str) -> Found:
        """By the library."""
        ts, back = when.around(3.0)
        data = fx.sweep(self.scene, self.eps, self.gamma, ts, accuracy, method)
        data = data.isel(eps=0)
        spent = data.dissipation.values[:, back[1]]
        return Found(
            data.z.values[:, back], spent, data.status.values, data.sup_error.values
        )

    def truth(self, when: Instants, by: str, tolerance: float) -> Found:
        """By the library at a tight accuracy, or by heyoka."""
        if by == "library":
            way = "resolved" if self.eps >= EVERY_SLIP else "windowed"
            return self.solved(when, tolerance, way)
        ts, back = when.around(3.0)
        z, spent = taylor_truth.solved(*self, ts, tolerance)
        nothing = np.zeros(self.gamma.size)
        return Found(z[:, back], spent[:, back[1]], nothing, nothing)


def gap(found: Found, true: Found, counted: np.ndarray, unit) -> np.ndarray:
    """The larger of both errors, of z in `unit`, over gamma."""
    off = np.where(counted, np.abs(found.z - true.z)[:, 1], 0.0).max(axis=1)
    last = np.abs(true.spent[:, -1:])
    return np.maximum(off / unit, (np.abs(found.spent - true.spent) / last).max(axis=1))


def cells(case: Case, method: str, by: str, tolerances):
    """The rows of a case."""
    when = instants(case.scene, case.eps, TIMES)
    true, other = (case.truth(when, by, tolerance) for tolerance in tolerances)
    counted = ~when.in_slip(true.z, case.eps, 3.0)
    keep = np.zeros(when.ts.size, dtype=bool)
    keep[when.asked] = True
    counted &= keep
    known = gap(other, true, counted, case.eps)
    for accuracy in ACCURACIES:
        found = case.solved(when, accuracy, method)
        error = gap(found, true, counted, case.eps)
        relative = gap(found, true, counted, found.farthest)
        columns = error / accuracy, relative / accuracy, known / accuracy, found.status
        for gamma, *numbers in zip(case.gamma, *columns, strict=True):
            yield Row(case.eps, float(gamma), float(accuracy), *numbers)


def report(rows: list[Row]) -> None:
    """Share of the cells below 1 and above 3, and the worst by accuracy and gamma."""
    columns: Any = Row(*np.array(rows, dtype=float).T)
    ok, known = columns.status == 0, columns.known < 1 / 3
    count = np.logical_and(ok, known)
    ratio = columns.ratio[count]
    print(
        f"{len(rows)} cells; status not OK: {np.sum(~ok)}; truth too rough: "
        f"{np.sum(ok & ~known)}; the other {count.sum()}",
        end="",
    )
    if not count.any():
        print(" say nothing")
        return
    print(
        f": below 1: {np.mean(ratio < 1):.2%}, above 3: {np.sum(ratio > 3)}, "
        f"worst {ratio.max():.3g}"
    )
    print("\nlargest error over accuracy (cells that count)\n")
    table(columns.gamma[count], columns.accuracy[count], ratio)
    low = np.logical_and(count, columns.gamma < 0.5)
    if low.any():
        print("\nthe same with z in sup |z_eps - z|\n")
        table(columns.gamma[low], columns.accuracy[low], columns.relative[low])


def table(gamma: np.ndarray, accuracy: np.ndarray, ratio: np.ndarray) -> None:
    """The largest ratio and how many cells count, by gamma and accuracy."""
    print("| gamma | " + " | ".join(f"{a:.0e}" for a in ACCURACIES) + " |")
    print("|" + "---|" * (1 + ACCURACIES.size))
    for one in np.unique(gamma):
        line = []
        for asked in ACCURACIES:
            some = ratio[(gamma == one) & (accuracy == asked)]
            line.append(f"{some.max():.2g} ({some.size})" if some.size else "-")
        print(f"| {one:g} | " + " | ".join(line) + " |")


def main() -> None:
    """Print offending cells as they come, and the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--method", default="auto")
    parser.add_argument("--bristles", nargs="+", default=list(BRISTLES))
    parser.add_argument("--loads", nargs="+", default=list(LOADS))
    parser.add_argument("--smallest", type=float, default=1e-7)
    parser.add_argument("--largest", type=float, default=1.0)
    parser.add_argument("--gamma", type=float, nargs="+", default=list(GAMMA))
    parser.add_argument("--by", choices=("library", "taylor"), default="library")
    parser.add_argument("--truth", type=float, nargs=2)
    options = parser.parse_args()
    best = (1e-8, 1e-9) if options.by == "library" else (1e-15, 1e-12)
    asked = options.method, options.by, options.truth or best
    rows = []
    for name in options.bristles:
        for load in options.loads:
            for eps in EPS[(options.smallest < EPS) & (options.largest >= EPS)]:
                case = Case(name, load, float(eps), np.array(options.gamma))
                for row in cells(case, *asked):
                    rows.append(row)
                    if row.status or not row.ratio < 1:
                        cell = f"{name} {load} eps={eps:.2g} gamma={row.gamma:g}"
                        word = Status.of(row.status).name
                        print(
                            f"{cell} accuracy={row.accuracy:.0e}: {row.ratio:.3g} of it, "
                            f"truth {row.known:.1g} {word}",
                            flush=True,
                        )
    report(rows)


if __name__ == "__main__":
    main()
