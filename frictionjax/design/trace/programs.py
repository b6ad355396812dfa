"""Programs of a fit to a trace, compiled beside what else there is to do."""

import contextlib
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from .problem import TraceProblem


@contextlib.contextmanager
def compiled_beside(problem: TraceProblem) -> Iterator[Callable[[], object]]:
    """Compile the trajectory, then its derivatives by bumps, in a thread.

    Yields a function that waits for the first. At the end the second is waited for, where
    it was begun. Both are called over no time at all, which costs nothing.
    """
    still = problem._replace(ts=np.zeros_like(problem.ts))
    numbers = np.zeros(problem.penalty.size)
    pool = ThreadPoolExecutor(1)
    try:
        first = pool.submit(still.run, numbers)
        pool.submit(still.run_bumps, numbers)
        yield first.result
    finally:
        pool.shutdown(cancel_futures=True)
