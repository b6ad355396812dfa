"""Scenes with every kind of bristle, for pictures of them, and what is in the pictures."""

import io

import numpy as np
from rods_that_turn import ROD, SURFACE

import frictionjax as fx

PULL = fx.loads.Pulled(fx.loads.Triangle(1.2, 4.0), 0.9)
BRISTLES = {
    "rod": ROD,
    "slanted": fx.bristles.SlantedSpring(1.0, 2.4, 1.0, -0.6),
    "vertical": fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    "bead": fx.bristles.Homothetic(1.0),
}


def pulled_scene(kind, **changed):
    bristle = BRISTLES[kind]
    start = float(bristle.root_constant()) - 0.9
    spring = fx.supports.Spring(1.0)
    made = fx.Scene(SURFACE, bristle, spring, PULL, 4.0, z0=start)
    return made.replace(**changed) if changed else made


def rendered(figure):
    figure.savefig(io.BytesIO(), format="png", dpi=40)
    return figure.axes


def line(axes, label):
    """Points (2, n) of the line of this name."""
    (found,) = (one for one in axes.lines if one.get_label() == label)
    return np.asarray(found.get_data(), dtype=float)
