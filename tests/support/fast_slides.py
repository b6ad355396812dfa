"""Scenes with fast slides, gamma about 1/2 and below, and times at which they are asked."""

import numpy as np

import frictionjax as fx

COS, SIN = [0.0, 0.0024, 0.0, 0.0012], [0.0096, 0.0, -0.0024, 0.0006]
PROFILES = {"sine": fx.profiles.Sine(0.1), "four": fx.profiles.Fourier(COS, SIN)}
BRISTLES = {
    "vertical": fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    "slanted": fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0),
    "angular": fx.bristles.AngularSpring(1.0, 1.414, 1.0, 0.3),
}
SINE, TRIANGLE = fx.loads.Sine(1.0488, 3.0), fx.loads.Triangle(0.8, 2.2)


def scene_of(profile, bristle, load, support=None):
    support = support or fx.supports.Spring(1.0)
    return fx.Scene(PROFILES[profile], BRISTLES[bristle], support, load, 3.0)


def quartic(z):
    return z**2 / 2 + z**4 / 4


SCENES = {
    "sine": scene_of("sine", "vertical", SINE),
    "overshoot": scene_of("sine", "slanted", TRIANGLE),
    "several folds": scene_of("four", "angular", SINE),
    "convex": scene_of("four", "slanted", SINE, fx.supports.Convex(quartic)),
}
TIMES = np.linspace(0.0, 3.0, 41)
