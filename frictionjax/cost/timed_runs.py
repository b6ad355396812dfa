"""Runs of any method on one cell, and how long they take once compiled."""

import time
from collections.abc import Callable
from typing import Any

import jax
import numpy as np

from ..wiggly import MAX_STEPS, Status, is_ours, solve
from .scipy_solvers import SCIPY, Run, run_scipy
from .settings import SETTINGS


def _run_solve(scene, eps, gamma, ts, accuracy, method, seconds) -> Run:
    """Through `solve`: our methods, which have their own bounds, and diffrax's."""
    found = solve(scene, eps, gamma, ts, accuracy, method, max_steps=_most(method, seconds))
    jax.block_until_ready((found.z, found.dissipation))
    status = found.status
    if status == Status.MAX_STEPS and not is_ours(method):
        status = Status.TOO_SLOW
    residual = float("nan") if found.residual is None else float(found.residual[-1])
    return Run(
        np.asarray(found.z),
        np.asarray(found.dissipation),
        status,
        float(found.stats["steps"]),
        float(found.stats["rejected"]),
        residual,
    )


def _most(method: Any, seconds: float) -> int:
    """Steps after which a run is ended."""
    return (
        MAX_STEPS
        if is_ours(method)
        else int(np.clip(seconds / SETTINGS.fast_step, 1, MAX_STEPS))
    )


def runner(scene, eps, gamma, ts, accuracy, method, seconds) -> Callable[[], Run]:
    """One run of a method, ready to be clocked."""
    run = run_scipy if method in SCIPY else _run_solve
    return lambda: run(scene, eps, gamma, ts, accuracy, method, seconds)


def timed(
    run: Callable[[], Run], repeats: int, seconds: float, first: float | None = None
) -> tuple[Run, dict[str, float]]:
    """The result of the last of a first run and warm ones, and how long they took.

    No more warm runs than fit into `seconds`, but one. `first`: seconds of a first run that
    has been. (Where a first run was ended, what it had
    compiled was counted as its time: 22 s where 2 were allowed. It is made again too.)
    """
    if first is None:
        _, first = clocked(run)
    warm: list[float] = []
    least, enough = SETTINGS.least_runs, SETTINGS.enough
    while len(warm) < repeats and (len(warm) < least or sum(warm) < enough):
        result, spent = clocked(run)
        warm.append(spent)
        if sum(warm) > seconds:
            break
    return result, _times(warm, max(0.0, first - float(np.median(warm))))


def clocked(run: Callable[[], Any]) -> tuple[Any, float]:
    """What a call returns, and its seconds."""
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
