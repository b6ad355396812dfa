"""What is under way, on standard error."""

import contextlib
import threading
import time
from collections.abc import Callable, Iterator

from tqdm import tqdm

from .workers import in_background

_FORMAT = "{desc}: {percentage:3.0f}% |{bar}| {elapsed} so far, {remaining} to go"
_WAITING = "{desc}, {elapsed} so far"
_PATIENCE, _EVERY = 2.0, 1.0  # s


def progress_bar(name: str, shown: bool) -> tqdm:
    """A bar from 0 to 1 for `with`."""
    return tqdm(total=1.0, disable=not shown, bar_format=_FORMAT, desc=name)


@contextlib.contextmanager
def waiting(name: str, shown: bool) -> Iterator[Callable[[str], None]]:
    """A line for work of unknown length, from two seconds on; gone when it is done.

    Yields a function that is told what is under way. The clock of the line goes on while
    a program compiles, when nothing is told.
    """
    done, told, began = threading.Event(), [""], time.time()

    def show() -> None:
        if done.wait(_PATIENCE):
            return
        # With a delay it does not show itself before its clock is set.
        with tqdm(bar_format=_WAITING, desc=name, leave=False, delay=1e-9) as line:
            line.start_t = began
            while True:
                line.set_description_str(f"{name}: {told[0]}" if told[0] else name)
                if done.wait(_EVERY):
                    return

    def tell(text: str) -> None:
        told[0] = text

    line = in_background(show, "progress", daemon=True) if shown else None
    try:
        yield tell
    finally:
        done.set()
        if line is not None:
            line.join()
