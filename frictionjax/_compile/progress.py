"""What is under way, on standard error."""

import contextlib
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import jax
from tqdm import tqdm

from .workers import in_background

_FORMAT = "{desc}: {percentage:3.0f}% |{bar}| {elapsed} so far, {remaining} to go{postfix}"
_WAITING = "{desc}, {elapsed} so far{postfix}"
_PATIENCE, _EVERY = 2.0, 1.0  # s
_WORTH = 0.5  # s of compilation that are told
_COMPILED = "/jax/core/compile/backend_compile_duration"  # an event of JAX


class _Compiler:
    """Seconds that XLA has compiled for, or fetched programs, since it was first asked."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._heard: float | None = None

    def seconds(self) -> float:
        """So far, of programs that are ready."""
        with self._lock:
            if self._heard is None:
                self._heard = 0.0
                jax.monitoring.register_event_duration_secs_listener(self._hear)
            return self._heard

    def _hear(self, event: str, duration_secs: float, **_: Any) -> None:
        if event == _COMPILED:
            with self._lock:
                self._heard = (self._heard or 0.0) + duration_secs


_COMPILER = _Compiler()


class _Told(tqdm):
    """A bar, or a line, that tells what part of its time went into compilation."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self._before = 0.0 if kwargs.get("disable") else _COMPILER.seconds()
        super().__init__(*args, **kwargs)

    def tell_compilation(self) -> None:
        """Programs that compile side by side take no longer than all together."""
        spent = min(_COMPILER.seconds() - self._before, time.time() - self.start_t)
        if spent >= _WORTH:
            self.set_postfix_str(f"{spent:.0f} s of it compiling", refresh=False)

    def update(self, n: float | None = 1) -> bool | None:
        if n is not None and self.total is not None:
            n = min(n, self.total - self.n)  # shares of 1 add up to more, by rounding
        if not self.disable:
            self.tell_compilation()
        return super().update(n)


def progress_bar(name: str, shown: bool) -> tqdm:
    """A bar from 0 to 1 for `with`."""
    return _Told(total=1.0, disable=not shown, bar_format=_FORMAT, desc=name)


@contextlib.contextmanager
def waiting(name: str, shown: bool) -> Iterator[Callable[[str], None]]:
    """A line for work of unknown length, from two seconds on; gone when it is done.

    Yields a function that is told what is under way. The clock of the line goes on while
    a program compiles, when nothing is told; once it is ready, the line says what part of
    the time that took.
    """
    done, told, began = threading.Event(), [""], time.time()
    before = _COMPILER.seconds() if shown else 0.0

    def show() -> None:
        if done.wait(_PATIENCE):
            return
        # With a delay it does not show itself before its clock is set.
        with _Told(bar_format=_WAITING, desc=name, leave=False, delay=1e-9) as line:
            line.start_t, line._before = began, before
            while True:
                line.tell_compilation()
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
