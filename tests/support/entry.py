"""A scene of the catalogue: what makes it hard, how it is built, and what is true."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import reference as ref

import frictionjax as fx

Truth = Callable[["Entry", np.ndarray], ref.Reference]
METHODS = ("auto", "windowed", "resolved")


def plain(one: "Entry", ts: np.ndarray) -> ref.Reference:
    """Plain integration of every slip, steps no longer than a few slips."""
    return ref.solve(one.system, one.eps, one.gamma, one.z0, ts)


def every_slip(one: "Entry", ts: np.ndarray) -> ref.Reference:
    """The same where slips are short: steps of a twentieth of a slip period."""
    period = one.eps * one.system.stiffness / one.system.rate
    return ref.solve(one.system, one.eps, one.gamma, one.z0, ts, period / 20)


@dataclass(frozen=True)
class Entry:
    """`build` makes the library's scene, `system` is the same by hand.

    `truth(entry, ts)` is the independent reference; `methods` those that can be asked for;
    `surface` where a picture should show the wiggles' force and not the trajectory;
    `window`: times of which a picture shows the trajectory.
    """

    why: str
    build: Callable[[], fx.Scene]
    system: ref.System
    eps: float
    gamma: float
    ts: np.ndarray = field(repr=False)
    z0: float = 0.0
    truth: Truth = plain
    methods: tuple[str, ...] = METHODS
    slow: bool = False
    surface: bool = False
    window: tuple[float, float] | None = None


def load_of(system: ref.System) -> tuple[np.ndarray, np.ndarray]:
    """Times and values of a load that is linear between its kinks."""
    times = np.array([0.0, *system.kinks, system.duration])
    return times, np.array([system.load(t) for t in times])


def pull(one: Entry, y: float) -> float:
    """V_eps' at the tip's phase y, N."""
    height, slope = one.system.w(y)
    _, ahead, climb = one.system.bristle(one.eps * height)
    return climb * slope / (1 + ahead * slope)


def strip_of(one: Entry) -> tuple[float, float]:
    """Extremes of V_eps', N."""
    force = [pull(one, y) for y in np.arange(4096) / 4096]
    return min(force), max(force)
