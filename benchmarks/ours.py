"""Our own solver as benchmarks call it, with its flags: set before JAX starts."""

import threading
import time
from typing import Any, NamedTuple

import jax
import numpy as np
from scenes import TIMES

import frictionjax as fx
from frictionjax.wiggly.batch import integrate_cells
from frictionjax.wiggly.lanes.loops import LOADER

fx.use_fast_cpu()
jax.config.update("jax_enable_x64", True)

_LONG = 5.0  # s of one run, beyond which two repeats are enough


def solve(
    one: fx.Scene, eps, gamma, accuracy: float, method: str = "auto", suprema: bool = False
):
    """Answers of all cells at once: z at TIMES, as of peers, and `suprema` beside it."""
    eps, gamma = np.atleast_1d(eps), np.atleast_1d(gamma)
    wanted = {"balanced": False, "suprema": suprema}
    return integrate_cells(one, eps, gamma, TIMES, accuracy, method, **wanted)


def _wait_for_loops() -> bool:
    """Whether loops compile that this run has asked for; not any more, then."""
    loading = [thread for thread in threading.enumerate() if thread.name.endswith(LOADER)]
    for thread in loading:
        thread.join()
    return bool(loading)


class Timed(NamedTuple):
    """Wall seconds, best and worst of the repeats and of the first call; CPU, least."""

    found: Any
    best: float
    worst: float
    first: float
    cpu: float


def timed(run, repeats: int = 5) -> Timed:
    wall, cpu = [], []
    while len(wall) <= (2 if wall and wall[-1] > _LONG else repeats):
        start, busy = time.perf_counter(), time.process_time()
        found = run()
        took = time.perf_counter() - start, time.process_time() - busy
        # Beside a loop that compiles only the first run counts.
        if not _wait_for_loops() or not wall:
            wall.append(took[0])
            cpu.append(took[1])
    return Timed(found, min(wall[1:]), max(wall[1:]), wall[0], min(cpu[1:]))
