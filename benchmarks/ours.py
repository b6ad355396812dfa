"""Our own solver as benchmarks call it; imported before JAX starts, for its flags."""

import time

import numpy as np

import frictionjax as fx

fx.use_fast_cpu()

import jax  # noqa: E402

jax.config.update("jax_enable_x64", True)

from scenes import TIMES  # noqa: E402

from frictionjax.wiggly.engine import integrate_cells  # noqa: E402

_LONG = 5.0  # s of one run, beyond which two repeats are enough


def solve(one: fx.Scene, eps, gamma, accuracy: float, method: str = "auto"):
    """Answers of all cells at once, at TIMES."""
    eps, gamma = np.atleast_1d(eps), np.atleast_1d(gamma)
    return integrate_cells(one, eps, gamma, TIMES, accuracy, method, balanced=False)


def timed(run, repeats: int = 5):
    """Result, best and worst seconds of the repeats, seconds of the first call."""
    seconds = []
    while len(seconds) <= (2 if seconds and seconds[-1] > _LONG else repeats):
        start = time.perf_counter()
        found = run()
        seconds.append(time.perf_counter() - start)
    return found, min(seconds[1:]), max(seconds[1:]), seconds[0]
