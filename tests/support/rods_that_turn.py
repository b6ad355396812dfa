"""Rods that turn over: on a stiff support they follow the load, on a soft one they jump."""

import frictionjax as fx

ROD = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
SURFACE = fx.profiles.Sine(0.5)
REACH = 1.0


def turning_scene(stiffness=1.0, bending=0.1, amplitude=2.5, duration=4.0, load=None):
    load = fx.loads.Triangle(amplitude, 4.0) if load is None else load
    return fx.Scene(
        SURFACE,
        ROD,
        fx.supports.Spring(stiffness),
        load,
        duration,
        effects=(fx.effects.NapFlip(bending),),
    )


def jumping_scene(duration=4.0):
    """On a support of 0.2 N/m: it goes over in jumps."""
    return turning_scene(0.2, 0.19, 1.3, duration)
