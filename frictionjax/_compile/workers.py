"""The library's threads: all start here.

XLA runs a compiled program on the core of the thread that calls it, so whatever goes on
side by side does so in threads. Nothing here is started on import.
"""

import contextlib
import functools
import threading
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import jax

from .._checks import in_64_bits

WORKERS = 2  # queues of lanes, or blocks of cells, at once: one core each
_BESIDE = threading.local()  # `others`: whether others work beside a thread


class _Crew(ThreadPoolExecutor):
    """Threads whose numbers have as many bits as those of who asks for the work."""

    def submit(self, fn: Callable, /, *args: Any, **kwargs: Any) -> Future:
        return super().submit(_with_bits_of_here(fn), *args, **kwargs)


def _with_bits_of_here(work: Callable) -> Callable:
    """`work` for other threads: `with jax.enable_x64(True):` holds in one thread."""
    wide = in_64_bits()

    def run(*args: Any, **kwargs: Any) -> Any:
        if in_64_bits() == wide:
            return work(*args, **kwargs)
        with jax.enable_x64(wide):
            return work(*args, **kwargs)

    return run


@functools.cache
def crew(work: str, size: int = WORKERS) -> ThreadPoolExecutor:
    """Threads that wait for one kind of work, kept: a pool for each sweep took 1 ms."""
    return _Crew(size, thread_name_prefix=f"frictionjax-{work}")


def cores() -> int:
    """How many the calling thread may work on: one where others work beside it."""
    return 1 if getattr(_BESIDE, "others", False) else WORKERS


def side_by_side(name: str, work: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
    """`work` of each item, on a core each; of one alone, in this thread on all.

    Where one raises, what has not begun is left out. `name`: of the threads.
    """
    items = list(items)
    if len(items) == 1:
        return [work(items[0])]

    def alone(item: Any) -> Any:
        _BESIDE.others = True
        try:
            return work(item)
        finally:
            _BESIDE.others = False

    made = [crew(name).submit(alone, item) for item in items]
    try:
        return [one.result() for one in made]
    finally:
        for one in made:
            one.cancel()


def in_background(
    work: Callable[[], Any], name: str, daemon: bool = False
) -> threading.Thread:
    """Do what will be asked for later; what fails here fails again there, and is heard of.

    `daemon`: the process may end meanwhile.
    """

    def quietly() -> None:
        with contextlib.suppress(Exception):
            work()

    thread = threading.Thread(
        target=_with_bits_of_here(quietly), name=f"frictionjax-{name}", daemon=daemon
    )
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

    thread = threading.Thread(target=_with_bits_of_here(run), daemon=True)
    thread.start()
    thread.join()
    if "error" in result:
        raise result["error"]
    return result["value"]
