"""Scenes of a vertical spring on four harmonics: they share their compiled programs."""

from typing import NamedTuple

import numpy as np
import reference as ref
from by_hand import piecewise
from entry import METHODS, Entry, Truth, plain
from scipy.optimize import brentq

import frictionjax as fx

END = 3.0
CALM = (0.0, 0.7, 0.7, -0.6, -0.6, 0.3, 0.3)
SPACED = (0.0, 0.6, 1.0, 1.8, 2.0, 2.7, 3.0)
SINE = ([0.0] * 4, [0.1 / ref.TWO_PI, 0.0, 0.0, 0.0])


class Spring(NamedTuple):
    """A vertical spring of stiffness 1 on four harmonics, a support, a load of 7 kinks.

    `length` and `force`: the same in other units; `pace`: the same slower.
    """

    why: str
    eps: float = 0.05
    gamma: float = 1.0
    surface: tuple = SINE
    alpha: float = 1.0
    k: float = 1.0
    times: tuple = SPACED
    values: tuple = CALM
    z0: float = 0.0
    length: float = 1.0
    force: float = 1.0
    pace: float = 1.0
    truth: Truth = plain
    methods: tuple = METHODS
    slow: bool = False
    shows_surface: bool = False
    window: tuple | None = None


class _Numbers(NamedTuple):
    """A spring's numbers in SI units."""

    eps: float
    k: float
    stiffness: float
    alpha: float
    times: np.ndarray
    values: np.ndarray


def _numbers(one: Spring) -> _Numbers:
    # eps^gamma z' = F keeps its form where time is counted in length^(1 + gamma)/force.
    time = one.pace * one.length ** (1 + one.gamma) / one.force
    return _Numbers(
        eps=one.eps * one.length,
        k=one.k * one.force / one.length,
        stiffness=one.force / one.length,
        alpha=one.alpha * one.force,
        times=np.asarray(one.times) * time,
        values=np.asarray(one.values) * one.force,
    )


def scene_of(one: Spring) -> fx.Scene:
    """The library's scene."""
    n, (cos, sin) = _numbers(one), one.surface
    return fx.Scene(
        fx.profiles.Fourier(cos, sin),
        fx.bristles.VerticalSpring(n.stiffness, (1 + one.alpha) * one.length, one.length),
        fx.supports.Spring(n.k),
        fx.loads.PiecewiseLinear(n.times, n.values),
        n.times[-1],
        one.z0 * one.length,
    )


def system_of(one: Spring) -> ref.System:
    """The same by hand."""
    n, (cos, sin) = _numbers(one), one.surface
    slope = sum(ref.TWO_PI * i * abs(s) for i, s in enumerate(sin, start=1))
    return ref.System(
        w=ref.series(list(cos), list(sin)),
        bristle=lambda eta: (0.0, 0.0, n.alpha + n.stiffness * eta),
        force=lambda z: n.k * z,
        load=piecewise(n.times, n.values),
        duration=float(n.times[-1]),
        kinks=tuple(n.times[1:-1]),
        steepest=slope * abs(n.alpha),
        stiffness=n.k,
        rate=float(np.abs(np.diff(n.values) / np.diff(n.times)).max()),
    )


def entry_of(one: Spring) -> Entry:
    """The scene for the catalogue."""
    system, n = system_of(one), _numbers(one)
    window = one.window and tuple(np.asarray(one.window) * n.times[-1] / one.times[-1])
    return Entry(
        why=one.why,
        build=lambda: scene_of(one),
        system=system,
        eps=n.eps,
        gamma=one.gamma,
        ts=np.linspace(0.0, float(n.times[-1]), 61),
        z0=one.z0 * one.length,
        truth=one.truth,
        methods=one.methods,
        slow=one.slow,
        surface=one.shows_surface,
        window=window,
    )


def slopes(*harmonics: float) -> tuple:
    """Sines whose slopes have these amplitudes."""
    sines = [s / (ref.TWO_PI * n) for n, s in enumerate(harmonics, start=1)]
    return [0.0] * 4, sines


# Where z + (1 + eps w) w' = 0 and falls, for the sine and eps = 0.05.
SUMMIT = 0.05 * brentq(
    lambda y: (
        0.05 * y
        + 0.1
        * np.cos(ref.TWO_PI * y)
        * (1 + 0.05 * 0.1 / ref.TWO_PI * np.sin(ref.TWO_PI * y))
    ),
    0.6,
    0.75,
)
