"""What eps = 1.3e-8 costs over eps = 1.3e-5 with windows; prints Markdown.

    python benchmarks/small_eps.py [--gamma 0.5 1 2] [--eps 1.3e-5 1.3e-8] [--no-error]

One cell at a time, accuracy 1e-3, 61 times, benchmark scene with its sine load and with a
triangular one. `s`: warm, best of the repeats. Error: outside slips in units of eps,
against our own method at accuracy 1e-5. `open`: of 61 brackets, those wider than half of
the accuracy, and the widest of all, in eps. `from z0`: times whose every slip was
integrated.

Not powers of ten: (1.0488 - 0.1)/1e-8 is an integer, the load would turn exactly at a
fold, and whether the last slip happens would hang on the last digit of the load.
"""

import argparse

import numpy as np
from ours import solve, timed
from scenes import AMPLITUDE, PERIOD, scene
from truth import ACCURACY, error_of, own

import frictionjax as fx
from frictionjax.wiggly import Status

LOADS = {
    "sine": fx.loads.Sine(AMPLITUDE, PERIOD),
    "triangle": fx.loads.Triangle(AMPLITUDE, PERIOD),
}
_COLUMNS = "load | gamma | eps | s | steps | error/eps | open | widest | from z0 | status"


def row(load: str, gamma: float, eps: float, with_error: bool) -> tuple[float, float]:
    """Prints a cell; its seconds and steps."""
    one = scene("vertical", LOADS[load])
    found, best, *_ = timed(lambda: solve(one, eps, gamma, ACCURACY, "windowed", True))
    error = np.nan
    if with_error:
        error = error_of(found.z[0], own(one, eps, gamma, 1e-5), eps)
    gap, how = found.gap[0], found.how[0]
    open_ = np.sum(~(gap <= 0.5 * ACCURACY))
    texts = [load, f"{gamma:g}", f"{eps:g}", f"{best:.3f}", f"{found.steps[0]:.0f}"]
    texts += [f"{error:.1e}", f"{open_}", f"{gap.max():.1e}", f"{np.sum(how == 0)}"]
    print(f"| {' | '.join([*texts, Status.of(found.status[0]).name])} |", flush=True)
    return best, float(found.steps[0])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--gamma", type=float, nargs="+", default=[1.0, 2.0, 0.5])
    parser.add_argument("--eps", type=float, nargs=2, default=[1.3e-5, 1.3e-8])
    parser.add_argument("--no-error", action="store_true")
    chosen = parser.parse_args()
    print(f"| {_COLUMNS} |\n{'|---' * 10}|")
    ratios = []
    for gamma in chosen.gamma:
        for load in LOADS:
            cells = [row(load, gamma, eps, not chosen.no_error) for eps in chosen.eps]
            (seconds, steps), (seconds1, steps1) = cells
            ratios.append(
                f"gamma {gamma:g}, {load}: {seconds1 / seconds:.2f} times the seconds, "
                f"{steps1 / steps:.2f} times the steps"
            )
    print("\n" + "\n".join(ratios))


if __name__ == "__main__":
    main()
