"""A steady slide in one direction, and what its forces are worth."""

from collections.abc import Callable
from typing import NamedTuple

import jax.numpy as jnp

from ..._checks import Real
from ...wiggly import Status
from .periodic_orbit import STEPS, PeriodicOrbit, SlideScene, least_pull, slide_forces
from .settings import SETTINGS


class Sides(NamedTuple):
    """Mean and peak force in N, and a `Status` as an integer, of one or more slides.

    `kept`: share of a disturbance that is left after a period.
    """

    mean: Real
    peak: Real
    code: Real
    kept: Real


def slide_scene(
    potential, eps: Real, gamma: Real, rate: Real, stiffness: Real, sign: Real
) -> SlideScene:
    """What a period is made of, by the numbers that users give."""
    return SlideScene(potential, eps, sign, rate * eps ** (gamma + 1), stiffness * eps)


def one_side(
    potential,
    eps: Real,
    gamma: Real,
    rate: Real,
    stiffness: Real,
    sign: Real,
    forces_of: Callable = slide_forces,
) -> tuple[Sides, PeriodicOrbit]:
    """The slide to the right or to the left, as `sign` is 1 or -1; traceable."""
    slide = slide_scene(potential, eps, gamma, rate, stiffness, sign)
    resolved, added = least_pull(slide)
    mean, peak, period = forces_of(resolved)
    code = _code(period, mean, added)
    return Sides(sign * mean, sign * peak, code, period.kept), period


def _code(period: PeriodicOrbit, mean: Real, added: Real) -> Real:
    closed = period.closed <= SETTINGS.open
    known = jnp.where(
        added <= SETTINGS.added * jnp.abs(mean), int(Status.OK), int(Status.STEP_TOO_SMALL)
    )
    code = jnp.where(closed, known, int(Status.SOLVER_FAILED))
    code = jnp.where(~closed & (period.used >= STEPS), int(Status.MAX_STEPS), code)
    # Errors of a period's steps add up until they are forgotten.
    remembered = SETTINGS.step_errors > SETTINGS.amplified * (1 - period.kept)
    code = jnp.where((code == int(Status.OK)) & remembered, int(Status.OPEN_BRACKET), code)
    return jnp.where(jnp.isfinite(mean), code, int(Status.NOT_FINITE))
