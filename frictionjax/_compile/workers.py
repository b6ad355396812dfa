"""The library's threads: all start here.

XLA runs a compiled program on the core of the thread that calls it, so whatever goes on
side by side does so in threads. Nothing here is started on import.
"""

import contextlib
import functools
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

WORKERS = 2  # queues of lanes, or blocks of cells, at once: one core each


@functools.cache
def crew(work: str, size: int = WORKERS) -> ThreadPoolExecutor:
    """Threads that wait for one kind of work, kept: a pool for each sweep took 1 ms."""
    return ThreadPoolExecutor(size, thread_name_prefix=f"frictionjax-{work}")


def in_background(
    work: Callable[[], Any], name: str, daemon: bool = False
) -> threading.Thread:
    """Do what will be asked for later; what fails here fails again there, and is heard of.

    `daemon`: the process may end meanwhile.
    """

    def quietly() -> None:
        with contextlib.suppress(Exception):
            work()

    thread = threading.Thread(target=quietly, name=f"frictionjax-{name}", daemon=daemon)
    thread.start()
    return thread


def interruptibly(work: Callable[[], Any]) -> Any:
    """Do `work` in a thread, so that Ctrl-C is heard while compiled code runs.

    Raises `KeyboardInterrupt` then, and leaves the thread behind; else what `work` raises.
    """
    result: dict[str, Any] = {}

    def run() -> None:
        try:
            result["value"] = work()
        except BaseException as error:  # raised again below, in the thread that waits
            result["error"] = error

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join()
    if "error" in result:
        raise result["error"]
    return result["value"]
