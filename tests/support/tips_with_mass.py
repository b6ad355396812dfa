"""Tips with mass by SciPy, and scenes of them: no line shared with the library."""

import math

import numpy as np
from scipy.integrate import solve_ivp

import frictionjax as fx

RHO = 0.1  # of a sine on a vertical spring that pulls with 1 N
AMPLITUDE, PERIOD = 1.0488, 3.0


def massive_scene(mass, exponent=0.0, *, load=None, duration=3.0, stiffness=1.0, z0=0.0):
    """A vertical spring on a sine; heights of eps/60 change its force by as much of it."""
    load = fx.loads.Sine(AMPLITUDE, PERIOD) if load is None else load
    return fx.Scene(
        fx.profiles.Sine(RHO),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(stiffness),
        load,
        duration,
        z0,
        effects=(fx.effects.Inertia(mass, exponent),),
    )


def mass_for(beta, eps, gamma):
    """The mass in kg with which beta is so large."""
    return beta * eps ** (1 + 2 * gamma) / (2 * math.pi * RHO)


def by_scipy(mass, eps, gamma, ts, method="DOP853", rtol=1e-12):
    """z and z' of `massive_scene` under its sine, and what was dissipated."""
    viscosity, turn = eps**gamma, 2 * math.pi

    def rates(t, state):
        z, v, _ = state
        phase = turn * z / eps
        height = RHO / turn * math.sin(phase)
        wiggle = (1 + eps * height) * RHO * math.cos(phase)
        force = AMPLITUDE * math.sin(turn * t / PERIOD) - z - wiggle
        return v, (force - viscosity * v) / mass, viscosity * v * v

    scales = [1e-12 * eps, 1e-12 * eps / math.sqrt(mass), 1e-13]
    found = solve_ivp(
        rates, (0.0, ts[-1]), [0.0] * 3, method, t_eval=ts, rtol=rtol, atol=scales
    )
    return np.asarray(found.y)
