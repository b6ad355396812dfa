"""Runs of any method on one cell, and how long they take once compiled."""

import time
from collections.abc import Callable
from typing import Any

import jax
import numpy as np

from .wiggly.general import SCIPY, Run, run_scipy
from .wiggly.integration import MAX_STEPS
from .wiggly.methods import is_ours
from .wiggly.planning import TABLEAU
from .wiggly.status import Status
from .wiggly.trajectory import Solution, solve

_FAST_STEP = 3e-6  # s of the fastest step through diffrax: bounds the number of steps
_ENOUGH = 0.5  # s of warm runs: what takes longer is timed once


def _work(found: Solution) -> tuple[float, float]:
    """Evaluations of the field and of its Jacobian of a run of ours.

    Lanes compute every stage of every attempt, with one Jacobian; so they wait for none.
    """
    steps = float(found.stats["steps"])
    return len(TABLEAU.a) * steps, steps


def _run_solve(scene, eps, gamma, ts, accuracy, method, seconds) -> Run:
    """Through `solve`: our methods, which have their own bounds, and diffrax's."""
    ours = is_ours(method)
    budget = MAX_STEPS if ours else int(seconds / _FAST_STEP)
    found = solve(scene, eps, gamma, ts, accuracy, method, max_steps=budget)
    jax.block_until_ready((found.z, found.dissipation))
    status = found.status
    if status == Status.MAX_STEPS and not ours:
        status = Status.TOO_SLOW
    evaluations, jacobians = _work(found) if ours else (float("nan"), float("nan"))
    residual = float("nan") if found.residual is None else float(found.residual[-1])
    return Run(
        np.asarray(found.z),
        np.asarray(found.dissipation),
        status,
        float(found.stats["steps"]),
        float(found.stats["rejected"]),
        evaluations,
        jacobians,
        residual,
    )


def runner(scene, eps, gamma, ts, accuracy, method, seconds) -> Callable[[], Run]:
    """One run of a method, ready to be clocked."""
    run = run_scipy if method in SCIPY else _run_solve
    return lambda: run(scene, eps, gamma, ts, accuracy, method, seconds)


def timed(
    run: Callable[[], Run], repeats: int, seconds: float
) -> tuple[Run, dict[str, float]]:
    """The result of the last of a first run and warm ones, and how long they took."""
    result, first = _clocked(run)
    if result.status != Status.OK and first > 0.5 * seconds:
        return result, _times([first], 0.0)
    warm: list[float] = []
    while not warm or (len(warm) < repeats and sum(warm) < _ENOUGH):
        result, spent = _clocked(run)
        warm.append(spent)
    return result, _times(warm, max(0.0, first - float(np.median(warm))))


def _clocked(run: Callable[[], Any]) -> tuple[Any, float]:
    start = time.perf_counter()
    result = run()
    return result, time.perf_counter() - start


def _times(warm: list[float], compiled: float) -> dict[str, float]:
    return {
        "seconds": float(np.median(warm)),
        "seconds_low": min(warm),
        "seconds_high": max(warm),
        "runs": len(warm),
        "compile_seconds": compiled,
    }
