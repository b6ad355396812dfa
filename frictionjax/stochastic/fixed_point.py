"""The density that repeats from well to well of a steady drive."""

from typing import NamedTuple

import numpy as np

from .driven_period import Drive, PeriodEnd, march_period, moved_on
from .settings import SETTINGS


class Window(NamedTuple):
    """Whole periods that a density lives on: from `first` on, `periods` of them."""

    first: int
    periods: int


def with_room(first: int, end: int) -> Window:
    """From `first` to `end` at least, in one of few sizes: 4, 6, 8, 12, 16, 24 ... periods.

    Another size is another program.
    """
    size = 4
    while size < end - first:
        size = size * 3 // 2 if size.bit_count() == 1 else size * 4 // 3
    return Window(first, size)


class PeriodicDensity(NamedTuple):
    """`density` (cells,) at the start of a period, on a window of n cells a period.

    `mean_force` in N; `change`: how much mass differs a period later; `lost`: mass that
    left the window or was lost to rounding, in one period. `reached` (cells,): the larger
    of the densities at both ends of the period. `rounds`: periods marched in all.
    """

    window: Window
    density: np.ndarray
    reached: np.ndarray
    mean_force: float
    change: float
    lost: float
    rounds: int

    @property
    def cells_a_period(self) -> int:
        """n."""
        return self.density.size // self.window.periods


def periodic_density(
    rises: np.ndarray,
    steps: int,
    drive: Drive,
    window: Window,
    start: np.ndarray,
    rounds: int | None = None,
) -> PeriodicDensity:
    """The fixed point of a period, by Anderson's acceleration of marching on and on.

    `rises`: as `march_period` takes them; `start` (cells,): a guess; `rounds`: the most
    periods to march, below the settings'. Where densities forget within a few periods
    marching alone does it; where the support is fast or soft, combinations of the last
    ones do.

    Source: D. G. Anderson, J. ACM 12, 547 (1965).
    """
    history: list[tuple[np.ndarray, np.ndarray]] = []
    density = start / np.sum(start)
    most = SETTINGS.most_periods
    for done in range(most if rounds is None else min(rounds, most)):
        end = march_period(density, rises, window.first, steps, drive)
        found = _compared(density, end, window, done + 1)
        if not found.change > SETTINGS.periodic:  # or NaN
            break
        moved, _ = moved_on(np.asarray(end.density), rises.size)
        moved = moved / np.sum(moved)
        history = [*history[1 - SETTINGS.combined :], (moved, moved - density)]
        density = _combined(history)
    return found


def _compared(
    density: np.ndarray, end: PeriodEnd, window: Window, rounds: int
) -> PeriodicDensity:
    after = np.asarray(end.density)
    moved, gone = moved_on(after, density.size // window.periods)
    return PeriodicDensity(
        window=window,
        density=density,
        reached=np.maximum(density, after),
        mean_force=float(end.mean_force),
        change=float(np.sum(np.abs(moved - density))),
        lost=max(abs(gone), float(end.leak), float(after[-1])),
        rounds=rounds,
    )


def _combined(history: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """The combination of densities whose changes nearly cancel; its mass is 1."""
    last, change = history[-1]
    if len(history) == 1:
        return last
    changes = np.stack([change - other for _, other in history[:-1]], axis=1)
    shares = np.linalg.lstsq(changes, change, rcond=1e-12)[0]
    return last - sum(s * (last - m) for s, (m, _) in zip(shares, history, strict=False))


def on_finer_cells(found: PeriodicDensity, factor: int) -> tuple[Window, np.ndarray]:
    """A guess on cells that are smaller by `factor`, and the periods that have mass.

    One empty period stays at either end.
    """
    n = found.cells_a_period
    masses = found.reached.reshape(-1, n).sum(axis=1)
    held = np.flatnonzero(masses > SETTINGS.no_mass)
    low = int(held[0]) - 1 if held.size else 0
    high = int(held[-1]) + 2 if held.size else found.window.periods
    window = with_room(found.window.first + low, found.window.first + high)
    cells = np.arange(window.periods * n * factor) / factor + low * n
    guess = np.interp(cells, np.arange(found.density.size), found.density, 0.0, 0.0)
    return window, np.maximum(guess, 0.0)
