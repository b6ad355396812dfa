"""A scene's steps by a solver of diffrax, as derivatives of trajectories take them."""

from functools import cache

import diffrax
import equinox as eqx
import jax.numpy as jnp

import frictionjax as fx
from frictionjax.wiggly.sequential.augmented_solver import AugmentedSolver, Recorder
from frictionjax.wiggly.sequential.integration import field_of
from frictionjax.wiggly.sequential.solvers_by_name import solver_of, with_tolerance
from frictionjax.wiggly.sequential.stepper import Stepper, blank_log, step_to

SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5),
    fx.supports.Spring(1.0),
    fx.loads.Ramp(1.0, 0.0),
    duration=1.0,
)
CONTROLLER = diffrax.PIDController(rtol=0.0, atol=1e-5)
ROOM = 2000  # of logs, for accepted steps
FIRST = jnp.asarray(1e-3)


@cache
def stepper_of(solver="resolved", eps=0.1):
    field = field_of(SCENE, jnp.asarray(eps), jnp.asarray(1.0))
    energy = field.energy(jnp.zeros(()), field.start(SCENE.z0))
    inner = with_tolerance(solver_of(solver), 1e-5)
    recorder = Recorder(field, energy, True, None)
    return Stepper(field, AugmentedSolver(inner, recorder))


def start_of(stepper):
    tip = stepper.field.start(SCENE.z0)
    return (tip, *stepper.solver.recorder.start(SCENE.z0), FIRST)  # and the longest step


def stepped(stepper, t, stop, most=10_000):
    """By one program, whatever `most` is."""
    return _stepped(stepper, t, stop, jnp.asarray(most))


@eqx.filter_jit
def _stepped(stepper, t, stop, most):
    start = start_of(stepper)
    log = blank_log(stepper, start, ROOM)
    return step_to(stop, stepper, CONTROLLER, t, start, FIRST, most=most, log=log)
