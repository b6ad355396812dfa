"""Scenes beside the same systems written by hand: bristles after the paper's geometry."""

import math
from dataclasses import dataclass

import numpy as np
import reference as ref

import frictionjax as fx


@dataclass(frozen=True)
class Case:
    scene: fx.Scene
    system: ref.System
    gamma: float
    z0: float


def vertical(k, rest, h):
    return lambda eta: (0.0, 0.0, k * (rest - h + eta))


def slanted(k, rest, h, theta):
    t, c = math.tan(theta), math.cos(theta)
    return lambda eta: (-eta * t, -t, k / c * (rest - (h - eta) / c))


def angular(k, length, h, rest):
    reach0 = math.sqrt(length**2 - h**2)

    def bristle(eta):
        drop = h - eta
        reach = math.sqrt(length**2 - drop**2)
        force = k * (math.acos(drop / length) - rest) / reach
        return reach - reach0, drop / reach, force

    return bristle


def sine_load(amplitude, period):
    return lambda t: amplitude * math.sin(ref.TWO_PI * t / period)


def piecewise(times, values):
    return lambda t: float(np.interp(t, times, values))
