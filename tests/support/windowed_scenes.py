"""Scenes of one bristle on few kinds of wells, and their cells by a way of choice."""

import numpy as np
from paths import path_of

import frictionjax as fx
from frictionjax.wiggly import batch as engine

TIMES = np.linspace(0.0, 3.0, 31)
SINE = fx.loads.Sine(1.0488, 3.0)
STEPS = fx.loads.PiecewiseLinear([0.0, 0.6, 1.1, 2.0, 3.0], [0.0, 0.9, 0.9, -0.7, 0.4])


def quartic(z):
    return z**2 / 2 + z**4 / 4


def scene_of(bristle="vertical", load=SINE, z0=0.0, support=None):
    profiles = {
        "vertical": fx.profiles.Sine(0.1),
        "angular": fx.profiles.Fourier(
            [0.0, 0.0024, 0.0, 0.0012], [0.0096, 0.0, -0.0024, 0.0006]
        ),
    }
    bristles = {
        "vertical": fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        "angular": fx.bristles.AngularSpring(1.0, 1.414, 1.0, 0.3),
    }
    support = support or fx.supports.Spring(1.0)
    return fx.Scene(profiles[bristle], bristles[bristle], support, load, 3.0, z0)


SCENES = {
    "sine load": scene_of(),
    "piecewise load": scene_of(load=STEPS),
    "several folds": scene_of("angular"),
    "convex support": scene_of(support=fx.supports.Convex(quartic)),
    "far start": scene_of(z0=0.5),
}


def cells(scene, eps, gamma, method, accuracy=1e-3, times=TIMES, **options):
    eps, gamma = (
        np.atleast_1d(np.asarray(eps, float)),
        np.atleast_1d(np.asarray(gamma, float)),
    )
    return engine.integrate_cells(scene, eps, gamma, times, accuracy, method, **options)


def outside_slips(scene, eps, gamma):
    """Tight values at TIMES, and which times are not inside a slip."""
    shift = 0.005 * eps / path_of(scene).speed
    around = np.clip(np.stack([TIMES - shift, TIMES, TIMES + shift]), 0, 3.0)
    every, place = np.unique(around, return_inverse=True)
    z = cells(scene, eps, gamma, "resolved", 1e-6, every, balanced=False).z[0]
    before, now, after = z[place.reshape(3, -1)]
    return now, np.abs(after - before) <= 0.05 * eps
