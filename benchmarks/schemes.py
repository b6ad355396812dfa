"""Steps a slip, rejected steps and error of Rosenbrock schemes, in lanes side by side.

    python benchmarks/schemes.py

1024 lanes of the benchmark scene start at the strip's edge at random times of its first
slide and run for four slips. Error: in periods at the end, median and 99%, against
Rodas5P at 1e-11 (lanes that end inside a slip are in the 99%). Seconds: one core, warm.
"""

import time

import jax
import numpy as np
from scenes import AMPLITUDE, EDGES, PERIOD, SLOPE, TWO_PI, scene

import frictionjax as fx
from frictionjax.wiggly.lanes.lane import LaneCells, LaneScene
from frictionjax.wiggly.lanes.loops import march
from frictionjax.wiggly.lanes.queue import Lanes, Segments
from frictionjax.wiggly.rosenbrock.rodas4p2 import RODAS4P2
from frictionjax.wiggly.rosenbrock.rodas5p import RODAS5P
from frictionjax.wiggly.rosenbrock.step import Tableau

fx.use_fast_cpu()  # before JAX computes anything
jax.config.update("jax_enable_x64", True)

# A. Sandu et al., Benchmarking stiff ODE solvers for atmospheric chemistry problems II,
# Atmospheric Environment 31:20 (1997).
RODAS3 = Tableau(
    order=3,
    gamma=0.5,
    a=((), (0.0,), (2.0, 0.0), (2.0, 0.0, 1.0)),
    c=((), (4.0,), (1.0, -1.0), (1.0, -1.0, -8 / 3)),
    times=(0.0, 0.0, 1.0, 1.0),
    time_derivative=(0.5, 1.5, 0.0, 0.0),
    dense=(),
)
# E. Hairer and G. Wanner, Solving ODEs II, Section IV.10.
_LAST = (1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950)
RODAS4 = Tableau(
    order=4,
    gamma=0.25,
    a=(
        (),
        (1.544,),
        (0.9466785280815826, 0.2557011698983284),
        (3.314825187068521, 2.896124015972201, 0.9986419139977817),
        _LAST,
        (*_LAST, 1.0),
    ),
    c=(
        (),
        (-5.6688,),
        (-2.430093356833875, -0.2063599157091915),
        (-0.1073529058151375, -9.594562251023355, -20.47028614809616),
        (7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160),
        (
            8.083246795921522,
            -7.981132988064893,
            -31.52159432874371,
            16.31930543123136,
            -6.058818238834054,
        ),
    ),
    times=(0.0, 0.386, 0.21, 0.63, 1.0, 1.0),
    time_derivative=(0.25, -0.1043, 0.1035, -0.0362, 0.0, 0.0),
    dense=(),
)
SCHEMES = {
    "Rodas3": RODAS3,
    "Rodas4": RODAS4,
    "Rodas4P2": RODAS4P2,
    "Rodas5P": RODAS5P,
}
LANES, SLIPS = 1024, 4


def run(tableau: Tableau, eps: float, gamma: float, tolerance: float):
    """Positions at the end, steps a slip, share rejected, seconds."""
    one = scene("vertical")
    parts = LaneScene(one.potential, one.support, one.load, *EDGES)
    start = np.random.default_rng(0).uniform(0.1, 0.5, LANES)
    edge = AMPLITUDE * np.sin(TWO_PI * start / PERIOD) - SLOPE
    end = np.arcsin((edge + SLIPS * eps + SLOPE) / AMPLITUDE) * PERIOD / TWO_PI
    first = 1e-2 * eps ** (1 + gamma)
    numbers = eps, eps**gamma, first, tolerance, tolerance, np.inf, 0.125
    cells = LaneCells(*(np.array([v]) for v in numbers))
    index, one_each = np.arange(LANES), np.ones(LANES)
    jobs = Lanes(0 * index, start, np.ceil(edge / eps), 0 * one_each, index, index + 1)
    ends = edge, edge + SLIPS * eps, 2 * one_each, 2 * one_each
    legs = Segments(start, end, *ends, friction=SLOPE * one_each, budget=1e6 * one_each)
    seconds = []
    for _ in range(3):
        begin = time.perf_counter()
        found = march(parts, cells, jobs, legs, tableau, True)
        seconds.append(time.perf_counter() - begin)
    steps = found.steps.sum()
    shares = steps / LANES / SLIPS, found.rejected.sum() / steps
    return found.well + found.tip, *shares, min(seconds)


def main() -> None:
    print(
        "gamma     eps  scheme    tolerance  steps/slip  rejected"
        "  median err   99% err  us/slip"
    )
    for gamma, eps in ((0.5, 1e-3), (1.0, 1e-2), (1.0, 1e-4), (2.0, 1e-3)):
        exact, *_ = run(RODAS5P, eps, gamma, 1e-11)
        for name, tableau in SCHEMES.items():
            for tolerance in (1e-3, 1e-4, 1e-5):
                y, steps, rejected, seconds = run(tableau, eps, gamma, tolerance)
                error = np.sort(np.abs(y - exact))
                high = error[int(0.99 * LANES)]
                each = 1e6 * seconds / LANES / SLIPS
                print(
                    f"{gamma:5g} {eps:7g}  {name:9s} {tolerance:9g} {steps:11.0f} "
                    f"{rejected:9.0%} {np.median(error):11.1e} {high:9.1e} {each:8.2f}",
                    flush=True,
                )


if __name__ == "__main__":
    main()
