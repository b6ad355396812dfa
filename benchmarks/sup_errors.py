"""Suprema of errors against full integration of every slip; prints Markdown.

    python benchmarks/sup_errors.py [--gamma 0.25 0.4] [--eps 1.3e-3 1.3e-4 1.3e-5]
        [--beyond 1.3e-6 1.3e-7 1.3e-8]

Without values after `--eps` LSODA is not needed.

sup |z_eps - z| over [0, T] of the benchmark scene from windows at accuracy 1e-3, and from
numbalsoda's LSODA (tolerance 1e-9) through every slip, at 16 times a slip or more, against
the closed form of the limit. Where tips forget slips only after hundreds of them
(gamma <= 1/2), windows stand for the rest of a slide by its slip map: `gap` is the
largest distance in eps that their brackets left, `sampled` the wells of a slide that were
looked at. Seconds of ours warm, of LSODA one run on one core.
"""

import argparse
import time

import numpy as np
from ours import solve, timed
from peers import lsoda_states
from scenes import AMPLITUDE, FASTEST, PERIOD, SLOPE, scene
from truth import ACCURACY

from frictionjax.wiggly import Status

_A_SLIP = 16  # times
_COLUMNS = "gamma | eps | windows | s | gap/eps | status | every slip | s | apart"


def limit(ts: np.ndarray) -> np.ndarray:
    """The play of the load: it drags z by its edges, rho = +-SLOPE."""
    load = AMPLITUDE * np.sin(2 * np.pi / PERIOD * ts)
    first, down = ts < PERIOD / 4, ts < 3 * PERIOD / 4
    falling = np.minimum(AMPLITUDE - SLOPE, load + SLOPE)
    rising = np.maximum(SLOPE - AMPLITUDE, load - SLOPE)
    return np.where(first, np.maximum(0.0, load - SLOPE), np.where(down, falling, rising))


def of_every_slip(eps: float, gamma: float) -> tuple[float, float]:
    """sup |z_eps - z| in m by full integration, and its seconds."""
    ts = np.linspace(0.0, PERIOD, int(np.ceil(_A_SLIP * PERIOD * FASTEST / eps)) + 1)
    begun = time.perf_counter()
    z = lsoda_states("vertical", eps, gamma, 1e-9, ts)
    return float(np.abs(z - limit(ts)).max()), time.perf_counter() - begun


def row(gamma: float, eps: float, whole: bool) -> None:
    """Prints a cell."""
    one = scene("vertical")
    found, best, *_ = timed(lambda: solve(one, eps, gamma, ACCURACY, "windowed", True))
    ours, status = float(found.sup_error[0]), Status.of(found.status[0]).name
    texts = [f"{gamma:g}", f"{eps:g}", f"{ours:.6e}", f"{best:.2f}"]
    texts += [f"{found.gap.max():.1e}", status]
    if whole:
        every, seconds = of_every_slip(eps, gamma)
        texts += [f"{every:.6e}", f"{seconds:.1f}", f"{abs(ours / every - 1):.1e}"]
    else:
        texts += ["-"] * 3
    print(f"| {' | '.join(texts)} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--gamma", type=float, nargs="+", default=[0.25, 0.4])
    parser.add_argument("--eps", type=float, nargs="*", default=[1.3e-3, 1.3e-4, 1.3e-5])
    parser.add_argument("--beyond", type=float, nargs="*", default=[1.3e-6, 1.3e-7, 1.3e-8])
    chosen = parser.parse_args()
    if chosen.eps:
        lsoda_states("vertical", 0.1, 1.0, 1e-3, np.linspace(0.0, PERIOD, 3))  # compiles
    print(f"| {_COLUMNS} |\n{'|---' * 9}|")
    for gamma in chosen.gamma:
        for eps in chosen.eps:
            row(gamma, eps, True)
        for eps in chosen.beyond:
            row(gamma, eps, False)


if __name__ == "__main__":
    main()
