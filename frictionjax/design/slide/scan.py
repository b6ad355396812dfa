"""Every value of a bristle's number at which its steady slide shows a wanted quantity."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from .settings import SETTINGS

Shown = Callable[[np.ndarray], np.ndarray]


class Scan(NamedTuple):
    """The quantity over an interval, NaN where a slide was not found.

    `nodes`, `values` (n,): sorted, with every extremum that the nodes show, polished;
    `turned` (n,): which those are.
    """

    nodes: np.ndarray
    values: np.ndarray
    turned: np.ndarray

    @property
    def known(self) -> bool:
        """Whether any slide was found."""
        return bool(np.any(np.isfinite(self.values)))

    @property
    def reach(self) -> tuple[float, float]:
        """The least and the largest quantity."""
        return float(np.nanmin(self.values)), float(np.nanmax(self.values))

    def failed(self, target: float) -> np.ndarray:
        """Nodes that leave open whether the target is reached.

        At an end, within 1% of the interval, only where the last values found grow towards
        the target and not ever less so: a pole, or a slide about to end.
        """
        lost = np.isnan(self.values)
        count = lost.size
        if not lost.any() or lost.all():
            return self.nodes[lost]
        first, last = np.flatnonzero(~lost)[[0, -1]]
        width = 10.0 ** -SETTINGS.decades[0] * (self.nodes[-1] - self.nodes[0])
        left, right = np.arange(count) < first, np.arange(count) > last
        if self.nodes[first] - self.nodes[0] <= width:
            lost &= ~left | _grows(self.values[first : first + 3], target)
        if self.nodes[-1] - self.nodes[last] <= width:
            lost &= ~right | _grows(self.values[last - 2 : last + 1][::-1], target)
        return self.nodes[lost]


def _grows(values: np.ndarray, target: float) -> bool:
    """Whether values, the one next to an end first, may go on to the target there.

    Their nodes come nearer by factors of ten, so those of a smooth function settle.
    """
    if values.size < 3:
        return True
    last, before = values[0] - values[1], values[1] - values[2]
    towards = last * (target - values[0]) > 0
    return bool(towards and abs(last) > SETTINGS.grows * abs(before))


def sliding(
    follows: Callable[[np.ndarray], np.ndarray], low: float, high: float
) -> list[tuple[float, float]]:
    """The parts of an interval where `follows` holds, its ends to rounding."""
    nodes = low + (high - low) * np.linspace(0, 1, SETTINGS.sides)
    nodes[-1] = high
    good = follows(nodes)
    changes = np.flatnonzero(good[1:] != good[:-1])
    inside = np.where(good[changes], nodes[changes], nodes[changes + 1])
    outside = np.where(good[changes], nodes[changes + 1], nodes[changes])
    # Padded, so that intervals of any number of parts share one compilation.
    pad = (0, nodes.size - changes.size)
    inside, outside = (np.pad(ends, pad, constant_values=low) for ends in (inside, outside))
    for _ in range(SETTINGS.halvings if changes.size else 0):
        middle = 0.5 * (inside + outside)
        holds = follows(middle)
        inside, outside = np.where(holds, middle, inside), np.where(holds, outside, middle)
    edges = inside[: changes.size].tolist()
    ends = [*([low] if good[0] else []), *edges, *([high] if good[-1] else [])]
    return list(zip(ends[::2], ends[1::2], strict=True))


def scan_slides(
    shown: Shown, slope: Callable[[float], float], low: float, high: float
) -> Scan:
    """Look over an interval: nodes that crowd towards its ends, extrema polished."""
    near = 10.0 ** -np.arange(*SETTINGS.decades)
    shares = np.concatenate([np.linspace(0, 1, SETTINGS.even), near, 1 - near])
    nodes = low + (high - low) * np.unique(shares)
    nodes[-1] = high
    values = shown(nodes)
    brackets = [(nodes[i - 1], nodes[i + 1]) for i in _bumps(values)]
    found = [_turn(slope, *ends) for ends in brackets]
    turns = np.array([turn for turn in found if turn is not None])
    if turns.size:
        values = np.concatenate([values, shown(turns)])
        nodes = np.concatenate([nodes, turns])
    order = np.argsort(nodes, kind="stable")
    return Scan(nodes[order], values[order], order >= nodes.size - turns.size)


def _bumps(values: np.ndarray) -> np.ndarray:
    """Inner places above or below both neighbours, by more than rounding."""
    before, here, after = values[:-2], values[1:-1], values[2:]
    least = SETTINGS.flat * np.abs(here)
    high = np.minimum(here - before, here - after)
    low = np.minimum(before - here, after - here)
    return 1 + np.flatnonzero((high > least) | (low > least))


def _turn(slope: Callable[[float], float], low: float, high: float) -> float | None:
    """Where the slope changes its sign; None where it is the same at both ends."""
    try:
        return brentq(slope, low, high, xtol=SETTINGS.turn * (high - low))
    except ValueError:  # a step between nodes, or no slide: nodes stand for themselves
        return None


def crossings(gap: Callable[[float], float], found: Scan, target: float) -> np.ndarray:
    """Every place between neighbours of the scan where the quantity is the target."""
    nodes, away = found.nodes, found.values - target
    roots = nodes[away == 0].tolist()
    for i in np.flatnonzero(away[:-1] * away[1:] < 0):
        size = SETTINGS.width * max(1.0, abs(nodes[i]))
        digits = {"xtol": size, "rtol": SETTINGS.relative_width}
        roots.append(brentq(gap, nodes[i], nodes[i + 1], **digits))
    return np.sort(np.array(roots))


def touching(found: Scan, target: float) -> np.ndarray:
    """Where the quantity turns at the target, or a rounding from it."""
    near = np.abs(found.values - target) <= SETTINGS.touch * abs(target)
    return found.nodes[near & found.turned]
