"""First and later seconds of a call."""

import statistics
import time

import jax


def timed(fn, repeats):
    """First and median later seconds, and the last result, blocked on."""
    seconds = []
    for _ in range(repeats + 1):
        before = time.perf_counter()
        result = jax.block_until_ready(fn())
        seconds.append(time.perf_counter() - before)
    return seconds[0], statistics.median(seconds[1:]), result
