"""How much effects change at one eps and gamma: closed forms, from above."""

from functools import singledispatch
from typing import NamedTuple

import numpy as np

from ..effects import (
    AbstractEffect,
    AxialLoad,
    CompliantArray,
    Inertia,
    NapFlip,
    Noise,
    RigidArray,
)
from .activated_slips import activated_slips
from .inertia_number import inertia_numbers
from .setting import AWAY, FASTEST, Setting
from .turns_on_folds import turns_on_folds

# Of beta, in eps: what a mass changes below the border, 0.7 (gamma = 0.75) to 1 was seen,
# and 1.14 on ramps where eps^gamma times speed is 0.1 to 3 rho. (2.8 where the load turns
# on a fold too, of which nothing is told.)
_LIGHT = 2.0
_ON_FOLD = "no bound: the load turns on a fold"
# Times the delay m_eps/eps^gamma.
_LATE = 5.0
# Of rho and beta^2, where eps^gamma times speed is above rho: up to 0.3 was seen.
_EVENED = 0.5
# Times sqrt(beta) over rho: least force that keeps a tip running. 4/pi for large beta; for
# a sine all are caught at rho where beta < 0.70.
_CAUGHT = 0.84
# Up to 1.4 was seen of four paths, of T/(eps rho) from 1e-6 to 1.
_SHAKEN = 2.0
# Standard deviations of a free tip on its spring: one path in 16,000 leaves them.
_SPREAD = 4.0


class Estimate(NamedTuple):
    """What an effect changes: the state in m, the friction in N; NaN where nothing says.

    `cost`: steps with it over steps without, NaN where that takes more than this estimate.
    `source`: of the estimate.
    """

    in_z: float
    in_force: float
    cost: float
    source: str


@singledispatch
def estimate_of(effect: AbstractEffect, at: Setting) -> Estimate:
    """Of an effect of the scene; of a class that says nothing else, unknown."""
    return Estimate(np.nan, np.nan, np.nan, "no estimate")


@estimate_of.register
def _(effect: RigidArray, at: Setting) -> Estimate:
    return _another(1.0)


@estimate_of.register
def _(effect: CompliantArray, at: Setting) -> Estimate:
    return _another(float(np.size(effect.offsets)))


@estimate_of.register
def _(effect: NapFlip, at: Setting) -> Estimate:
    return _another(np.nan)


def _another(cost: float) -> Estimate:
    """Arrays, and rods that turn over, are another scene, not another accuracy."""
    return Estimate(np.nan, np.nan, cost, "none: another scene")


@estimate_of.register
def _(effect: AxialLoad, at: Setting) -> Estimate:
    return Estimate(0.0, 0.0, 1.0, "exact: it is read off, nothing moves otherwise")


@estimate_of.register
def _(effect: Inertia, at: Setting) -> Estimate:
    """By beta: a light mass delays slips, a heavy one runs until the pull has fallen.

    Delays are a few times `m_eps/eps^gamma`: a slip is late by the logarithm of its own
    speed over the slide's, until the tip slips. Where that is so long that there are times
    outside of both slips, one tip is a slip behind the other. A tip that runs is caught
    where the force falls to about `rho/sqrt(beta)`; on the spring it swings as far again at
    most. One that viscosity carries over wells without a rest runs the more evenly the
    heavier it is.
    """
    beta = float(inertia_numbers(at.scene.potential, effect, at.eps, at.gamma))
    viscosity = at.eps**at.gamma
    delay = float(effect.mass_at(at.eps)) / viscosity / (1 + beta)
    light = _LIGHT * min(beta, 1.0) * at.eps
    faster = np.clip(2 * at.rho / (viscosity * at.speed), np.e, FASTEST)
    if np.log(faster) * delay * at.speed < 2 * AWAY * at.eps:
        light = min(light, _LATE * at.fastest * at.speed * delay)
    if light < at.eps and turns_on_folds(at, at.stiffest * light / at.fastest).size:
        return Estimate(np.nan, np.nan, np.nan, f"{_ON_FOLD}, beta = {beta:.3g}")
    carried = min(1.0, viscosity * at.speed / at.rho) ** 2
    even = at.rho * _EVENED * min(beta, 1.0) ** 2 * carried
    run = at.rho * (1 - min(1.0, _CAUGHT / np.sqrt(beta)))
    force = at.stiffest * light / at.fastest + even + run
    source = f"beta = {beta:.3g}: overdamped far below 1"
    return Estimate(light + (even + 2 * run) / at.softest, force, np.nan, source)


@estimate_of.register
def _(effect: Noise, at: Setting) -> Estimate:
    """By barriers: slips come earlier where noise may lift tips over what is left of one.

    A slip that comes earlier is felt by as much as higher friction is, and by a well at
    most; inside their wells tips shake as wide as the barrier that they may be lifted over.
    """
    heat = float(np.asarray(effect.temperature_at(at.eps)))
    found = activated_slips(at, heat)
    earlier = found.force / at.softest
    # Less than a well apart is no bound where the load turns on a fold.
    if at.fastest * earlier < at.eps and turns_on_folds(at, found.force).size:
        return Estimate(np.nan, found.force, np.nan, _ON_FOLD)
    felt = _SHAKEN * at.apart(earlier) + found.width * at.eps
    if found.free:  # no barrier is left that holds: the support alone does
        felt += _SPREAD * float(np.sqrt(heat / at.softest))
    barrier = f"T/(eps rho) = {heat / (at.eps * at.rho):.3g}"
    source = f"{barrier}, barriers below {found.logarithm:.3g} T are passed"
    return Estimate(felt, found.force, np.nan, source)
