"""Runs of any method on one cell, and how long they take once compiled."""

import time
from collections.abc import Callable
from typing import Any

import jax
import numpy as np

from .wiggly.engine import scheme_of
from .wiggly.general import SCIPY, Run, run_scipy
from .wiggly.integration import MAX_STEPS
from .wiggly.methods import is_ours
from .wiggly.status import Status
from .wiggly.trajectory import solve

_FAST_STEP = 3e-6  # s of the fastest step through diffrax: bounds the number of steps
_ENOUGH = 0.5  # s of warm runs: what takes longer is timed once


def _run_diffrax(scene, eps, gamma, ts, accuracy, method, seconds) -> tuple[Run, float]:
    ours = is_ours(method)
    budget = MAX_STEPS if ours else int(seconds / _FAST_STEP)
    found = solve(scene, eps, gamma, ts, accuracy, method, max_steps=budget)
    jax.block_until_ready((found.z, found.dissipation))
    steps, rejected = float(found.stats["steps"]), float(found.stats["rejected"])
    evaluations = jacobians = float("nan")
    if ours:
        # The first stage's values serve a rejected step too; the last is the next one's.
        stages = len(scheme_of(float(found.stats["tolerance"])).tableau.a)
        evaluations, jacobians = (stages - 1) * steps + steps - rejected, steps - rejected
    status = found.status
    if status == Status.MAX_STEPS and not ours:
        status = Status.TOO_SLOW
    counts = status, steps, rejected, evaluations, jacobians
    run = Run(np.asarray(found.z), np.asarray(found.dissipation), *counts)
    residual = found.residual
    return run, float("nan") if residual is None else float(residual[-1])


def runner(scene, eps, gamma, ts, accuracy, method, seconds) -> Callable:
    if method in SCIPY:
        parts = scene, eps, gamma, ts, accuracy, method, seconds
        return lambda: (run_scipy(*parts), float("nan"))
    return lambda: _run_diffrax(scene, eps, gamma, ts, accuracy, method, seconds)


def timed(run: Callable, repeats: int, seconds: float) -> tuple[Any, dict[str, float]]:
    """The result of a first run and warm ones, and how long they took."""

    def clocked() -> float:
        nonlocal result
        start = time.perf_counter()
        result = run()
        return time.perf_counter() - start

    result: Any = None
    first = clocked()
    status = result[0].status
    if status != Status.OK and first > 0.5 * seconds:
        return result, _times([first], 0.0)
    warm = [clocked()]
    while len(warm) < repeats and sum(warm) < _ENOUGH:
        warm.append(clocked())
    return result, _times(warm, max(0.0, first - float(np.median(warm))))


def _times(warm: list[float], compiled: float) -> dict[str, float]:
    return {
        "seconds": float(np.median(warm)),
        "seconds_low": min(warm),
        "seconds_high": max(warm),
        "runs": len(warm),
        "compile_seconds": compiled,
    }
