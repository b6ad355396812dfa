"""Rods that turn over: on a stiff support they follow the load, on a soft one they jump."""

import numpy as np

import frictionjax as fx
from frictionjax.numerics import cubic
from frictionjax.wiggly.turning.hybrid_motion import integrate_turning

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


def sampled(scene, eps, gamma, accuracy=1e-3, spacing=0.1, gap=2e-3):
    """Times, states and modes of the library's curve: its steps, and places between them.

    `spacing` in eps and `gap` in s: samples lie so close.
    """
    run = integrate_turning(
        scene,
        eps,
        gamma,
        effect=scene.effects[0],
        ts=np.array([0.0, float(scene.duration)]),
        accuracy=accuracy,
        budget=10**7,
        noted=True,
    )
    made = run.made
    length, rise = made.end - made.begin, made.z1 - made.z0
    parts = np.maximum(np.abs(rise) / (spacing * eps), length / gap)
    parts = np.maximum(np.ceil(parts), 1).astype(int)
    step = np.repeat(np.arange(parts.size), parts)
    number = np.arange(step.size) - np.repeat(np.cumsum(parts) - parts, parts) + 1
    share = number / parts[step]
    slopes = [(slope * length)[step] for slope in (made.slope0, made.slope1)]
    z = made.z0[step] + np.asarray(cubic(share, rise[step], *slopes))
    last = share == 1
    z[last], ts = made.z1, made.begin[step] + share * length[step]
    ts[last] = made.end
    ts, z = np.append(0.0, ts), np.append(made.z0[0], z)
    mode = np.append(made.mode[0], made.mode[step]).astype(int)
    later = np.append(True, np.diff(ts) > 0)
    return ts[later], z[later], mode[later]
