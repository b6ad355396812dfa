"""Requests that come faster than they are answered."""

import threading
from collections.abc import Callable, Sequence
from typing import Generic, TypeVar

_Request = TypeVar("_Request")


class NewestOnly(Generic[_Request]):
    """Hands on requests, in a thread of its own; what newer ones overtake is dropped.

    The thread that asks, that of a kernel, goes on reading requests: else all of them
    would be answered, one after the other, long after the slider has stopped.
    """

    def __init__(self, answer: Callable[[_Request], None]):
        self._answer = answer
        self._waiting: list[_Request] = []
        self._lock = threading.Lock()
        self._worker: threading.Thread | None = None
        self.dropped = 0

    def ask(self, requests: Sequence[_Request]) -> None:
        """Answer these next, in their order, in place of all that wait."""
        with self._lock:
            self.dropped += len(self._waiting)
            self._waiting = list(requests)
            if self._worker is None and self._waiting:
                self._worker = threading.Thread(target=self._work, name="explore")
                self._worker.start()

    def wait(self) -> None:
        """Until the newest request is answered."""
        worker = self._worker
        if worker is not None:
            worker.join()

    def _work(self) -> None:
        while (request := self._next()) is not None:
            try:
                self._answer(request)
            except BaseException:
                with self._lock:
                    self._worker = None  # the next request finds a new one
                raise

    def _next(self) -> _Request | None:
        with self._lock:
            if self._waiting:
                return self._waiting.pop(0)
            self._worker = None
            return None
