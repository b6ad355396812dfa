"""A sweep against compiled solvers, at equal accuracy, on both cores.

    python benchmarks/sweep.py [--gamma 1 2] [--smallest 1e-4] [--peers heyoka lsoda]

The benchmark scene: a vertical spring on a sine of slope 0.1, k_h = alpha = 1, load
1.0488 sin(2 pi t/3) on [0, 3]. Error: max over 61 times, those inside a slip left out,
in units of eps, against our own method at accuracy 1e-6. Each peer runs at its cheapest
tolerance of those listed that reaches 1e-3, 8 lanes of one batch or one lane a core, and
a cell's time is half of what one core takes. Peers are left out of cells where they would
take more than a minute, which is said.
"""

import argparse
import importlib.util
import sys
import time
from pathlib import Path

import numpy as np

import frictionjax as fx

fx.use_fast_cpu()

import jax  # noqa: E402

jax.config.update("jax_enable_x64", True)
sys.path.insert(0, str(Path(__file__).parent))

from solvers import AMPLITUDE, PERIOD, SLOPE, TIMES, TWO_PI, scene  # noqa: E402

from frictionjax.wiggly.engine import integrate_cells  # noqa: E402

ACCURACY = 1e-3
PATIENCE = 60.0  # s a cell
TOLERANCES = (1e-6, 1e-8, 1e-10)


def truth(eps: float, gamma: float) -> tuple[np.ndarray, np.ndarray]:
    """States at TIMES, and which of them are not inside a slip."""
    shift = 0.005 * eps / (AMPLITUDE * TWO_PI / PERIOD)
    around = np.clip(np.stack([TIMES - shift, TIMES, TIMES + shift]), 0, PERIOD)
    every, place = np.unique(around, return_inverse=True)
    cell = np.array([eps]), np.array([gamma])
    z = integrate_cells(scene(), *cell, every, 1e-6, "auto", balanced=False).z[0]
    before, now, after = z[place.reshape(3, -1)]
    return now, np.abs(after - before) <= 0.05 * eps


def ours(eps: np.ndarray, gamma: np.ndarray, method: str):
    """States of all cells, seconds warm (best, worst of 5), seconds of the first call."""
    seconds = []
    for _ in range(6):
        start = time.perf_counter()
        found = integrate_cells(
            scene(), eps, gamma, TIMES, ACCURACY, method, balanced=False
        )
        seconds.append(time.perf_counter() - start)
    return found, min(seconds[1:]), max(seconds[1:]), seconds[0]


def heyoka_batch(eps: float, gamma: float, tolerance: float):
    """Seconds of one core a lane, and states, of heyoka in a batch of 8 equal lanes."""
    import heyoka as hy

    y = hy.make_vars("y")
    drag = eps ** (1 + gamma)
    normal = 1.0 + eps * SLOPE / TWO_PI * hy.sin(TWO_PI * y)
    pull = AMPLITUDE * hy.sin(TWO_PI / PERIOD * hy.time)
    rate = (pull - eps * y - SLOPE * hy.cos(TWO_PI * y) * normal) / drag
    start = time.perf_counter()
    lanes = hy.taylor_adaptive_batch([(y, rate)], np.zeros((1, 8)), tol=tolerance)
    compiled = time.perf_counter() - start
    start = time.perf_counter()
    grid = np.repeat(TIMES[:, None], 8, axis=1)
    _, values = lanes.propagate_grid(grid)
    return (time.perf_counter() - start) / 8, eps * values[:, 0, 0], compiled


def lsoda(eps: float, gamma: float, tolerance: float):
    """Seconds of one core, and states, of numbalsoda's compiled LSODA."""
    from numba import cfunc
    from numbalsoda import lsoda as solve
    from numbalsoda import lsoda_sig

    @cfunc(lsoda_sig)
    def rate(t, y, dy, p):
        phase = TWO_PI * y[0]
        normal = 1 + p[0] * SLOPE / TWO_PI * np.sin(phase)
        pull = AMPLITUDE * np.sin(TWO_PI * t / PERIOD)
        dy[0] = (pull - p[0] * y[0] - SLOPE * np.cos(phase) * normal) / p[1]

    numbers = np.array([eps, eps ** (1 + gamma)])
    start = time.perf_counter()
    found, success = solve(
        rate.address, np.zeros(1), TIMES, numbers, rtol=1e-13, atol=tolerance, mxstep=10**9
    )
    seconds = time.perf_counter() - start
    return seconds, np.where(success, eps * found[:, 0], np.nan), 0.0


PEERS = {"heyoka": heyoka_batch, "lsoda": lsoda}


def installed() -> list[str]:
    """Peers that can be imported; numbalsoda needs a Fortran compiler to install."""
    needs = {"heyoka": "heyoka", "lsoda": "numbalsoda"}
    return [name for name in PEERS if importlib.util.find_spec(needs[name])]


def cheapest(peer, eps, gamma, exact, counted) -> tuple[float, float, str]:
    """Both-core seconds and error at the cheapest tolerance that is accurate enough."""
    best = (np.inf, np.nan, "never accurate")
    for tolerance in TOLERANCES:
        seconds, z, _ = peer(eps, gamma, tolerance)
        error = np.abs(z - exact)[counted].max() / eps
        if error < ACCURACY and seconds / 2 < best[0]:
            best = (seconds / 2, error, f"{tolerance:g}")
            break
        if seconds > PATIENCE:
            return best
    return best


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--gamma", type=float, nargs="+", default=[1.0, 2.0])
    parser.add_argument("--smallest", type=float, default=1e-4)
    parser.add_argument("--cells", type=int, default=16)
    parser.add_argument("--peers", nargs="*", default=installed())
    arguments = parser.parse_args()
    grid = np.geomspace(0.1, arguments.smallest, arguments.cells)
    gamma, eps = (a.ravel() for a in np.meshgrid(arguments.gamma, grid, indexing="ij"))
    exact = [truth(e, g) for e, g in zip(eps, gamma, strict=True)]
    for method in ("auto", "resolved"):
        found, best, worst, first = ours(eps, gamma, method)
        errors = [
            np.abs(z - now)[counted].max() / e
            for z, (now, counted), e in zip(found.z, exact, eps, strict=True)
        ]
        print(
            f"ours, {method}: {best:.3f} s ({worst:.3f} at worst) for {eps.size} cells, "
            f"first call {first:.1f} s, largest error {max(errors):.1e} eps",
            flush=True,
        )
    print(f"{'gamma':>5s} {'eps':>8s}  peer, s on both cores, error/eps, tolerance")
    total, patience = 0.0, {}
    for e, g, (now, counted) in zip(eps, gamma, exact, strict=True):
        row, fastest = [], np.inf
        for name in arguments.peers:
            if patience.get((name, g)):
                row.append(f"{name} left out")
                continue
            seconds, error, tolerance = cheapest(PEERS[name], e, g, now, counted)
            patience[name, g] = not seconds < PATIENCE / 2
            row.append(f"{name} {seconds:.4f} {error:.0e} {tolerance}")
            fastest = min(fastest, seconds)
        total += fastest
        print(f"{g:5g} {e:8.2g}  {'; '.join(row)}", flush=True)
    print(f"fastest peer of each cell, added up: {total:.3f} s")


if __name__ == "__main__":
    main()
