"""Rods, supports that are no springs, and a sharp sawtooth."""

import math
from dataclasses import replace

import jax
import numpy as np
import reference as ref
from by_hand import piecewise
from entry import Entry, Truth, every_slip
from springs import CALM, END, SPACED, Spring, entry_of, scene_of

import frictionjax as fx

_TS = np.linspace(0.0, END, 61)


def _part(
    why: str, slope: float, force: float, eps: float, bristle, by_hand, truth: Truth
) -> Entry:
    """A bristle on a sine, loaded by `force/0.2` of its friction's width."""
    y = np.arange(4096) / 4096
    pulls = [_pull(by_hand, ref.sine(slope), eps, v) for v in y]
    width = max(pulls) - min(pulls)
    values = [force * width * v / 0.2 for v in CALM]
    stiffness = 5 * force * width / (100 * eps)
    system = ref.System(
        w=ref.sine(slope),
        bristle=by_hand,
        force=lambda z: stiffness * z,
        load=piecewise(SPACED, values),
        duration=END,
        kinks=tuple(SPACED[1:-1]),
        steepest=width,
        stiffness=stiffness,
        rate=float(np.abs(np.diff(values) / np.diff(SPACED)).max()),
    )

    def build() -> fx.Scene:
        spring = fx.supports.Spring(stiffness)
        load = fx.loads.PiecewiseLinear(SPACED, values)
        return fx.Scene(fx.profiles.Sine(slope), bristle(), spring, load, END)

    return Entry(why, build, system, eps, 0.1, _TS, truth=truth, slow=True)


def _pull(by_hand, w, eps: float, y: float) -> float:
    height, slope = w(y)
    _, ahead, climb = by_hand(eps * height)
    return climb * slope / (1 + ahead * slope)


def _angular(k: float, length: float, h: float, rest: float):
    """An angular spring without differences that cancel where L is nearly h."""

    def reach_at(eta):
        return math.sqrt((length - h + eta) * (length + h - eta))

    def bristle(eta):
        drop, reach = h - eta, reach_at(eta)
        change = eta * (2 * h - eta) / (reach + reach_at(0.0))
        return change, drop / reach, k * (math.atan2(reach, drop) - rest) / reach

    return bristle


def _rod(
    why: str, theta: float, slope: float, force: float, eps: float, truth=every_slip
) -> Entry:
    numbers = (1.0, 1 / math.cos(theta), 1.0, theta - 0.4)

    def bristle():
        return fx.bristles.AngularSpring(*numbers)

    return _part(why, slope, force, eps, bristle, _angular(*numbers), truth)


def _held_by(why: str, energy, force) -> Entry:
    base = Spring(why, 0.03)
    plain = scene_of(base)

    def build() -> fx.Scene:
        support = fx.supports.Convex(energy)
        return fx.Scene(plain.profile, plain.bristle, support, plain.load, END)

    one = entry_of(base)
    system = replace(one.system, force=force, stiffness=1.0)
    return replace(one, build=build, system=system, slow=True)


def _quartic(z):
    return z**4 / 4 + 1e-3 * z**2 / 2


def _soft_plus(z):
    return 0.05 * z**2 + jax.nn.softplus(10 * z) / 10 - z / 2


# Slopes: a steep flank of a tenth of the period, of which 64 harmonics keep the edge.
_N = np.arange(1, 65)
_SIN = 0.02 * np.sin(0.2 * np.pi * _N) / _N**2 * np.exp(-((_N / 40) ** 2))
_SAWTOOTH = Spring(
    "64 harmonics, a flank of a tenth of a period",
    eps=0.1,
    surface=(np.zeros(64), _SIN),
    slow=True,
    shows_surface=True,
)

OTHER_PARTS = {
    "rod upright": _rod("theta_lim near 0: tan = 0.11, slope 0.1", 0.11, 0.1, 1.0, 1e-3),
    "rod lying flat": _rod(
        "theta_lim near pi/2: cot = 0.12, slope 0.1", 1.45, 0.1, 0.2, 1e-3
    ),
    "L - h = 1e-9 L": _rod("a rod all but vertical", math.acos(1 - 1e-9), 2e-5, 0.5, 2e-5),
    "rod hardly admissible": _rod(
        "1 + a omega = 1e-3", math.atan(0.1 * (1 + 1e-3)), 0.1, 1.0, 1e-4
    ),
    "quartic well": _held_by(
        "a support that is soft at 0", _quartic, lambda z: z**3 + 1e-3 * z
    ),
    "soft-plus": _held_by(
        "a support ten times stiffer near 0",
        _soft_plus,
        lambda z: 0.1 * z + 0.5 * math.tanh(5 * z),
    ),
    "sawtooth": entry_of(_SAWTOOTH),
}
