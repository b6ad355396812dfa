"""How much effects change at one eps and gamma: closed forms, from above."""

from functools import singledispatch
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Float

from .._checks import Real
from .._compile import Program, in_chunks
from ..effects import AbstractEffect, CompliantArray, Inertia, NapFlip, RigidArray
from ..model import AbstractPotential, Coefficients, Scene
from ..slide_laws import SlideData, predict_errors

_PLACES = 512  # of a period, for forces of a well and their change
# Outside of slips tips move at most so many times as fast as their slide: 0.05 eps in 0.5%
# of a slip period. A slip that comes earlier is felt by that much.
_FASTEST = 10.0
# Of beta, in eps: what a mass changes below the border, 0.7 (gamma = 0.75) to 1 was seen.
_LIGHT = 2.0
# Times sqrt(beta) over rho: least force that keeps a tip running. 4/pi for large beta; for
# a sine all are caught at rho where beta < 0.70.
_CAUGHT = 0.84


class Estimate(NamedTuple):
    """What an effect changes: the state in m, the friction in N; NaN where nothing says.

    `cost`: time with it over time without. `source`: of the estimate.
    """

    in_z: float
    in_force: float
    cost: float
    source: str


class Setting(NamedTuple):
    """What estimates are made from: a scene as engines see it, one cell, and its laws."""

    scene: Scene
    eps: float
    gamma: float
    law: Coefficients
    data: SlideData


@Program
def _rest(potential: AbstractPotential, eps: Real, Y: Float[Array, " n"]):
    """Q' and Q'' in N/m, W'' and W''' in N at phases Y."""

    def rest(phase: Real) -> Real:
        return potential._rest(eps, phase)

    def leading(phase: Real) -> Real:
        return potential._leading(phase)

    def at(phase: Real) -> tuple[Real, ...]:
        slope, force = jax.grad(rest), jax.grad(leading)
        steep = jax.grad(force)
        return slope(phase), jax.grad(slope)(phase), steep(phase), jax.grad(steep)(phase)

    return jax.vmap(at)(Y)


def higher_order(at: Setting) -> Estimate:
    """What `eps^2 Q` changes: `LeadingOrder` leaves it out.

    The extreme forces of a well change by `eps Q'(Y*)`, and to second order by
    `(eps Q'')^2/(2 |W'''|)`, as the steepest place moves; strip and slides by that over
    Phi'', and a tip on its way to the next slip by ten times as much. Where tips rest
    inside wells they move by `eps^2 Q'/W''` besides.
    """
    Y = np.arange(_PLACES) / _PLACES - 0.5
    Y = np.append(Y, [at.data.phase[np.argmax(s * at.data.force)] for s in (1.0, -1.0)])
    Y = Y - np.round(Y)
    fixed = at.scene.potential, np.asarray(at.eps)
    slope, bend, steep, sharp = in_chunks(_rest, _PLACES + 2, fixed, (Y,))
    tops = slice(-2, None)
    moved = (at.eps * bend[tops]) ** 2 / (2 * np.maximum(np.abs(sharp[tops]), 1e-300))
    force = float(np.max(at.eps * np.abs(slope[tops]) + moved))
    inside = at.eps**2 * np.max(np.abs(slope)) / np.max(np.abs(steep))
    in_z = _FASTEST * force / float(np.min(at.data.stiffness)) + float(inside)
    return Estimate(in_z, force, 1.0, "eps Q' at the steepest places (Lemma 2)")


def finite_speed(at: Setting) -> Estimate:
    """What viscosity adds to friction on the fastest slide: force and state beyond rho.

    NaN where the limit does not slide through a few wells.
    """
    plain = at.data._replace(change=np.zeros_like(at.data.change))
    found = predict_errors(plain, np.array([at.eps]), np.array([at.gamma]))
    in_z = float(found["strip_excess"].errors[0, 0])
    law = found["strip_excess"].laws[0]
    stiff = float(np.max(at.data.stiffness))
    return Estimate(in_z, in_z * stiff, np.nan, f"law of a slide: {law.name}")


@singledispatch
def estimate_of(effect: AbstractEffect, at: Setting) -> Estimate:
    """Of an effect of the scene; of a class that says nothing else, unknown."""
    return Estimate(np.nan, np.nan, np.nan, "no estimate")


@estimate_of.register
def _(effect: RigidArray, at: Setting) -> Estimate:
    return _array(1.0)


@estimate_of.register
def _(effect: CompliantArray, at: Setting) -> Estimate:
    return _array(float(np.size(effect.offsets)))


@estimate_of.register
def _(effect: NapFlip, at: Setting) -> Estimate:
    return _array(np.nan)


def _array(cost: float) -> Estimate:
    """Arrays, and rods that turn over, are another scene, not another accuracy."""
    return Estimate(np.nan, np.nan, cost, "none: another scene")


@estimate_of.register
def _(effect: Inertia, at: Setting) -> Estimate:
    """By beta: a light mass delays slips, a heavy one runs until the pull has fallen.

    A tip that runs is caught where the force falls to about `rho/sqrt(beta)`; on the spring
    it swings as far again at most.
    """
    from ..wiggly import inertia_numbers  # nothing else needs it

    beta = float(inertia_numbers(at.scene.potential, effect, at.eps, at.gamma))
    rho = max(float(at.law.rho_plus), -float(at.law.rho_minus))
    soft, stiff = float(np.min(at.data.stiffness)), float(np.max(at.data.stiffness))
    light = _LIGHT * min(beta, 1.0) * at.eps
    run = rho * (1 - min(1.0, _CAUGHT / np.sqrt(beta)))
    force = stiff * light / _FASTEST + run
    source = f"beta = {beta:.3g}: overdamped far below 1"
    return Estimate(light + 2 * run / soft, force, np.nan, source)
