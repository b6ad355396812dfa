"""Bristles of design tests, and slopes of what was designed."""

import numpy as np

import frictionjax as fx

HOMOTHETIC = fx.bristles.Homothetic(1.0)
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
ANGULAR = fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2)


def slopes_of(fit, order=0, points=4096):
    """A derivative of w' of a fit, or of every iterate, by its Fourier series."""
    cos, sin = np.asarray(fit.cos), np.asarray(fit.sin)
    turns = 2 * np.pi * np.arange(1, cos.shape[-1] + 1)
    phase = np.outer(turns, np.arange(points) / points)
    waves = (cos - 1j * sin) * (1j * turns) ** (order + 1)
    return (waves @ np.exp(1j * phase)).real
