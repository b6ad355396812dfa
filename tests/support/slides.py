"""Wells whose forces have closed forms, and scenes that slide."""

import numpy as np

import frictionjax as fx
from frictionjax.model.friction_coefficients import coefficients_jit
from frictionjax.slide_laws import slide_data
from frictionjax.slide_laws.well_force import well_force

RHO = 0.1


PLACES = np.unique(
    np.concatenate(
        [
            np.arange(1024) / 1024,
            *(
                (top + s * np.geomspace(1e-4, 0.06, 96)) % 1
                for top in (0, 0.5)
                for s in (1, -1)
            ),
        ]
    )
)


def wells(force, sign=1, change=0.0):
    """Of a force with its extremes at 0 and 1/2."""
    return well_force(PLACES, force(PLACES), change + 0.0 * PLACES, sign)


def sine(y):
    return RHO * np.cos(2 * np.pi * y)


def flat(y):
    """Extremes of order 4."""
    return RHO / 8 * (9 * np.cos(2 * np.pi * y) - np.cos(6 * np.pi * y))


def straight(y):
    """Flanks of 0.1 and -0.1 of 0.3 of a period each, C^1 between."""
    return RHO * np.clip(1.7 * np.cos(2 * np.pi * y), -1, 1)


FOUR = fx.profiles.Fourier([0.004, -0.002, 0.0, 0.0005], [0.008, 0.003, -0.001, 0.0])


def scene(profile=FOUR, angle=0.6, amplitude=1.0488, period=3.0, rest=2.4):
    return fx.Scene(
        profile,
        fx.bristles.SlantedSpring(1.0, rest, 1.0, angle),
        fx.supports.Spring(1.0),
        fx.loads.Sine(amplitude, period),
        3.0,
    )


def known(one, eps):
    return slide_data(one, coefficients_jit(one.potential), eps)
