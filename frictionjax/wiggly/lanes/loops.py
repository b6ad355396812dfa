"""Lanes: many short integrations of the wiggly system, side by side in compiled loops."""

import threading
from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Shaped

from ..._compile import ARRAYS, in_background
from ..rosenbrock import Tableau
from .lane import LaneCells, LaneScene
from .queue import Lanes, SegmentEnds, Segments, Tables, run_queue
from .settings import SETTINGS

LOADER = "loader"  # threads that compile loops in the background


class Room(NamedTuple):
    """Rows of the tables of a compiled loop."""

    cells: int
    jobs: int
    legs: int

    def holds(self, needed: "Room") -> bool:
        """Whether that many rows fit, and no more than one size too large."""
        fits = all(a >= b for a, b in zip(self, needed, strict=True))
        return fits and self.legs <= SETTINGS.growth * max(needed.legs, _ROOM.legs)


_ROOM = Room(*SETTINGS.room)
_WIDTHS = SETTINGS.narrow, SETTINGS.width


def room_for(needed: Room) -> Room:
    """Room for that many rows: all sizes grow together."""
    size = _ROOM
    while not all(a >= b for a, b in zip(size, needed, strict=True)):
        size = Room(*(SETTINGS.growth * rows for rows in size))
    return size


def _padded(rows: np.ndarray, size: int) -> np.ndarray:
    padded = np.ones((size, rows.shape[1]))
    padded[: rows.shape[0]] = rows
    return padded


def loop_times(longest: Any, together: Any) -> tuple[Any, Any]:
    """How long the narrow and the wide loop take for a queue, in steps of the wide one.

    `longest`, `together`: work of its longest job, and of all, in steps.
    """
    narrow = SETTINGS.narrow_step * np.maximum(longest, together / SETTINGS.narrow)
    return narrow, np.maximum(longest, together / SETTINGS.width)


class _Loops:
    """Loops compiled so far, by what they simulate; two threads compile one once."""

    def __init__(self) -> None:
        self._known: dict[Any, dict[Room, threading.Lock]] = {}
        self._lock = threading.Lock()
        self._done: set = set()
        self._waited: dict[Any, float] = {}

    def run(self, program: tuple, needed: Room, fill: Callable[[Room], Tables]) -> Array:
        """Run the loop on tables of a room that `fill` makes."""
        kind = _kind(program[:2]), program[2:]
        with self._lock:
            rooms = self._known.setdefault(kind, {})
            fitting = [room for room in rooms if room.holds(needed)]
            room = min(fitting, key=lambda r: r.legs) if fitting else room_for(needed)
            compiling = rooms.setdefault(room, threading.Lock())
        if (kind, room) in self._done:
            return run_queue(*program, fill(room))
        with compiling:
            found = run_queue(*program, fill(room))
            with self._lock:  # others may be looking through it
                self._done.add((kind, room))
            return found

    def choose(self, fixed: tuple, needed: Room, times: dict[tuple, float]) -> tuple:
        """Which of the loops that take `times` for a queue runs it: the fastest, or one
        that is there until the fastest would have paid.

        Loops as `summed` and width; times in wells of a lane of the wide one.
        """
        best = min(times, key=lambda own: times[own])
        kind = _kind(fixed)
        with self._lock:
            there = [own for own in times if self._holds((kind, own), needed)]
            # A study had two loops compiled, one for 0.6 ms of lanes.
            there = there or [own for own in times if self._is_coming((kind, own), needed)]
            if not there:  # one with sums serves whatever is asked next
                general = True, best[1]
                little = times[general] - times[best] <= SETTINGS.patience
                return general if little else best
            serving = min(there, key=lambda own: times[own])
            lost = times[serving] - times[best]
            if lost > SETTINGS.at_once:
                return best
            waiting = kind, best, room_for(needed)
            before = self._waited.get(waiting, 0.0)
            self._waited[waiting] = before + lost
        if before <= SETTINGS.patience < before + lost:
            self.load((*fixed, *best), needed)
        return serving

    def is_done(self, fixed: tuple, own: tuple, needed: Room) -> bool:
        """Whether a loop is compiled that has room for so many rows."""
        kind = _kind(fixed), own
        with self._lock:
            return self._holds(kind, needed)

    def _holds(self, kind: tuple, needed: Room) -> bool:
        return any(k == kind and room.holds(needed) for k, room in self._done)

    def _is_coming(self, kind: tuple, needed: Room) -> bool:
        return any(room.holds(needed) for room in self._known.get(kind, ()))

    def load(self, program: tuple, needed: Room) -> None:
        """Compile the loop in the background, where none is there that does."""
        kind = _kind(program[:2]), program[2:]
        with self._lock:
            if self._holds(kind, needed):
                return
            self._known.setdefault(kind, {}).setdefault(room_for(needed), threading.Lock())

        in_background(lambda: self.run(program, needed, _nothing), LOADER)


def _nothing(room: Room) -> Tables:
    widths = (len(LaneCells._fields), len(Lanes._fields), len(Segments._fields))
    tables = (np.ones((n, w)) for n, w in zip(room, widths, strict=True))
    return Tables(*tables, waiting=np.asarray(0))


def _kind(fixed: tuple) -> tuple:
    """What compiled loops of a scene and a tableau depend on, numbers left out."""
    leaves, structure = jax.tree_util.tree_flatten(fixed)
    shapes = (x.shape if isinstance(x, ARRAYS) else x for x in leaves)
    return structure, *shapes


_LOOPS = _Loops()


def _enough(summed: bool) -> list[tuple[bool, int]]:
    """Loops, as `summed` and width, that find what is wanted: all to the same bits."""
    return [(sums, width) for sums in {summed, True} for width in _WIDTHS]


def prepare(
    scene: LaneScene, tableau: Tableau, needed: Room, summed: bool, narrow: bool = False
) -> None:
    """Compile the loop that `march` will want, in the background; a guess may be wrong.

    Not where one is there that serves meanwhile. The narrow one has sums: see `choose`.
    """
    fixed = scene, tableau
    own = (True, SETTINGS.narrow) if narrow else (summed, SETTINGS.width)
    if not any(_LOOPS.is_done(fixed, one, needed) for one in _enough(summed)):
        _LOOPS.load((*fixed, *own), needed)


def march(
    scene: LaneScene,
    cells: LaneCells,
    jobs: Lanes,
    legs: Segments,
    tableau: Tableau,
    summed: bool,
    work: Shaped[np.ndarray, " jobs"] | None = None,
) -> SegmentEnds:
    """Run all jobs side by side; each lane takes the next job when it is through.

    NumPy arrays in and out. What a lane finds does not depend on the others, to the last
    bit. `work` (jobs,): about in proportion to the steps of each; None: to its wells.
    """
    tables = [
        np.stack(np.broadcast_arrays(*(np.asarray(c, float) for c in t)), -1)
        for t in (cells, jobs, legs)
    ]
    needed = Room(*(len(t) for t in tables))

    def fill(room: Room) -> Tables:
        rows = (_padded(t, size) for t, size in zip(tables, room, strict=True))
        return Tables(*rows, waiting=np.asarray(needed.jobs))

    of_jobs = _wells(cells, jobs, legs) if work is None else work
    by_width = dict(zip(_WIDTHS, loop_times(of_jobs.max(), of_jobs.sum()), strict=True))
    times = {
        (sums, width): by_width[width] * (1.0 if sums == summed else SETTINGS.with_sums)
        for sums, width in _enough(summed)
    }
    own = _LOOPS.choose((scene, tableau), needed, times)
    found = _LOOPS.run((scene, tableau, *own), needed, fill)
    return SegmentEnds(*np.asarray(found)[: needed.legs].T)


def _wells(cells: LaneCells, jobs: Lanes, legs: Segments) -> np.ndarray:
    """Wells that each job goes through, (jobs,)."""
    eps = np.asarray(cells.eps)[np.asarray(jobs.cell, dtype=int)]
    way = np.concatenate([[0.0], np.cumsum(np.abs(legs.guide1 - legs.guide0))])
    return (way[np.asarray(jobs.past_leg)] - way[np.asarray(jobs.first_leg)]) / eps
