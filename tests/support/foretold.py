"""A scene whose cost is foretold, and a machine that is known."""

import numpy as np

import frictionjax as fx
from frictionjax.cost.machine_cost import MachineCost

TIMES = np.linspace(0.0, 3.0, 61)
MACHINE = MachineCost(0.01, 0.002, 1e-5, 1e-7, 1e-6, 5.0, 1e9)


def scene_of(load=None):
    return fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        load or fx.loads.Sine(1.0488, 3.0),
        duration=3.0,
    )
