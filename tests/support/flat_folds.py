"""Scenes whose force is flat where it is largest: tips are not let go all at once."""

import numpy as np

import frictionjax as fx


def sawtooth(rise=0.8, height=0.05, rounding=0.02, harmonics=64):
    """Straight flanks, the corners rounded by a Gaussian; lengths in periods."""
    n = np.arange(1, harmonics + 1)
    slopes = (height / rise + height / (1 - rise)) / (2j * np.pi * n)
    slopes = slopes * (1 - np.exp(-2j * np.pi * n * rise))
    waves = slopes / (2j * np.pi * n) * np.exp(-2 * (np.pi * n * rounding) ** 2)
    return fx.profiles.Fourier(2 * waves.real, -2 * waves.imag)


def quartic(slope=0.12):
    """`w'` falls off from its extremes, at 0 and 1/2, like the fourth power."""
    sin = slope / (2 * np.pi) * np.array([9 / 8, 0.0, -1 / 24])
    return fx.profiles.Fourier(np.zeros(3), sin)


def scene_of(profile, bristle):
    load, support = fx.loads.Sine(1.0, 3.0), fx.supports.Spring(1.0)
    return fx.Scene(profile, bristle, support, load, 3.0)


SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
VERTICAL = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
SCENES = {
    "sawtooth": scene_of(sawtooth(), SLANTED),
    "quartic": scene_of(quartic(), VERTICAL),
}
