"""Programs of a fit to a trace, compiled beside what else there is to do."""

import contextlib
from collections.abc import Callable, Iterator
from concurrent.futures import wait

import numpy as np

from ..._compile import crew
from .problem import TraceProblem


@contextlib.contextmanager
def compiled_beside(problem: TraceProblem) -> Iterator[Callable[[], object]]:
    """Compile the trajectory, then its derivatives by bumps, in a thread.

    Yields a function that waits for the first. At the end the second is waited for, where
    it was begun. Both are called over no time at all, which costs nothing.
    """
    still = problem._replace(ts=np.zeros_like(problem.ts))
    numbers = np.zeros(problem.penalty.size)
    beside = crew("programs", 1)
    first = beside.submit(still.run, numbers)
    both = first, beside.submit(still.run_bumps, numbers)
    try:
        yield first.result
    finally:
        wait([compiling for compiling in both if not compiling.cancel()])
