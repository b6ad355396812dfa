"""Two worker processes that solve the same cell at once: what both cores are worth."""

import multiprocessing as mp
import time
from typing import NamedTuple

import numpy as np


class Outcome(NamedTuple):
    """Of a lane: wall seconds while both cores work, and half the CPU seconds of one.

    z at TIMES, seconds of compilation, and what failed, "" if nothing.
    """

    seconds: float
    cpu: float
    z: np.ndarray | None
    compiled: float
    failure: str


_REPEATS, _ENOUGH = 7, 0.5  # runs at most, and seconds after which no further one


def _serve(pipe) -> None:
    """In a worker: solve the cells that come through the pipe."""
    from peers import PEERS

    while True:
        name, *cell = pipe.recv()
        try:
            run = PEERS[name](*cell)
            pipe.send(run.compiled)
            pipe.recv()  # both start together
            pipe.send(_repeat(run))
        except Exception as error:
            pipe.send(f"{error}"[:60] or type(error).__name__)


def _repeat(run) -> tuple[float, float, np.ndarray]:
    """Least wall and CPU seconds a lane, and z."""
    wall, cpu, begin = [], [], time.perf_counter()
    while len(wall) < _REPEATS and time.perf_counter() - begin < _ENOUGH:
        start, busy = time.perf_counter(), time.process_time()
        z = run.solve()
        wall.append(time.perf_counter() - start)
        cpu.append(time.process_time() - busy)
    return min(wall) / run.lanes, min(cpu) / run.lanes, z


class Cores:
    """Both cores, one process each; killed and started again when a cell takes too long."""

    def __init__(self, count: int = 2):
        self._count, self._workers = count, []

    def solve(self, job: tuple, patience: float) -> Outcome:
        """The same job `(peer, scene, eps, gamma, tolerance)` on all cores at once."""
        if not self._workers:
            self._workers = [_worker() for _ in range(self._count)]
        pipes = [pipe for _, pipe in self._workers]
        for pipe in pipes:
            pipe.send(job)
        compiled = self._replies(pipes, 120.0)
        failures = [c for c in compiled if isinstance(c, str)]
        if failures:
            self.stop()
            return Outcome(np.inf, np.inf, None, 0.0, failures[0])
        for pipe in pipes:
            pipe.send("go")
        replies = self._replies(pipes, patience)
        failures = [r for r in replies if isinstance(r, str)]
        if failures:
            if any(f.startswith("> ") for f in failures):
                self.stop()
            return Outcome(np.inf, np.inf, None, max(compiled), failures[0])
        wall = np.mean([r[0] for r in replies]) / self._count
        cpu = min(r[1] for r in replies) / self._count
        return Outcome(wall, cpu, replies[0][2], max(compiled), "")

    def _replies(self, pipes, patience: float) -> list:
        end = time.perf_counter() + patience
        late = f"> {patience:g} s"
        return [
            p.recv() if p.poll(max(0.0, end - time.perf_counter())) else late for p in pipes
        ]

    def stop(self) -> None:
        for process, _ in self._workers:
            process.kill()
            process.join()
        self._workers = []


def _worker():
    context = mp.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(theirs,), daemon=True)
    process.start()
    return process, ours
