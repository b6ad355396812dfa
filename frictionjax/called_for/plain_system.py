"""How much of the plain system matters: the potential's higher order, finite speed."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import Real
from .._compile import Interpreted, in_chunks
from ..bristles import Homothetic, Linear
from ..model import AbstractPotential, BristlePotential, tabulated_potentials
from ..numerics import slope_of
from ..slide_laws import predict_errors
from .estimates import Estimate
from .setting import Setting
from .turns_on_folds import turns_on_folds

_PLACES = 512  # of a period, for forces of a well and their change
_SLIP = 130.0  # times eps^(1 + gamma)/max|W''|: a slip, with its way over the fold
_FELT = 6.0  # times eps: the most that tips move while a slip is late
# Times the law of a slide, of which 0.978 to 1.011 was seen on scenes that ship (`pytest -m
# slow tests/called_for/test_estimates.py` holds the bound).
_LAW = 1.03
_STRAIGHT = 1e-300  # N: W''' of a straight flank, by which nothing is divided


class HigherOrder(NamedTuple):
    """`estimate`: by a closed form, no bound at `turns` (s) of the load on a fold."""

    estimate: Estimate
    turns: Float[np.ndarray, " turns"]


@Interpreted
def _rest(potential: AbstractPotential, eps: Real, Y: Float[Array, " n"]):
    """Q' and Q'' in N/m, W'' and W''' in N at phases Y.

    Derivatives of all phases at once: traced in half the time of those of each.
    """
    rest = slope_of(jax.vmap(lambda phase: potential._rest(eps, phase)))
    _, steep, sharp = _leading(potential, Y)
    return *jax.jvp(rest, (Y,), (jnp.ones_like(Y),)), steep, sharp


@Interpreted
def _rest_of_tip(potential: BristlePotential, eps: Real, Y: Float[Array, " n"]):
    """The same, of one tip: `eps Q' = V_eps' - W'`, with no derivative of Q.

    That of Q goes through two inverses, and takes 1.2 of 2.1 s of a first `explain` to
    trace. What the difference loses is a rounding of forces: 4e-6 of Q' at eps = 1e-8.
    """
    tips = jax.vmap(lambda phase: potential.well_coordinate(phase, eps))(Y)
    forces = jax.vmap(lambda tip: potential.at_tip(tip, eps)[:2])
    (force, stretch), (climb, _) = jax.jvp(forces, (tips,), (jnp.ones_like(Y),))
    slope, steep, sharp = _leading(potential, Y)
    return (force - slope) / eps, (climb / stretch - steep) / eps, steep, sharp


def _leading(potential: AbstractPotential, Y: Float[Array, " n"]) -> tuple:
    """W', W'' and W''' in N."""
    along = (jnp.ones_like(Y),)
    slope = slope_of(jax.vmap(potential._leading))
    both = jax.jvp(lambda Y: jax.jvp(slope, (Y,), along), (Y,), along)
    (first, second), (_, third) = both
    return first, second, third


def higher_order(at: Setting) -> HigherOrder:
    """What `eps^2 Q` changes: `LeadingOrder` leaves it out.

    The extreme forces of a well change by `eps Q'(Y*)`, and to second order by
    `(eps Q'')^2/(2 |W'''|)`, as the steepest place moves by `eps^2 Q''/W'''`; strip and
    slides by that over Phi'', and a tip on its way to the next slip by `fastest` times as
    much. A well that has moved holds its tip as far ahead, and until the support has been
    pulled on by as much: `fastest` times less once. (Over a rough surface, eps = 0.02,
    gamma = 2, slips were late by 20 times what the extreme force says.) Where that is more
    than a slip takes, one tip is a slip behind the other (`Setting.apart`). Where tips rest
    inside wells they move by `eps^2 Q'/W''`, and slips last longer as forces change. Where
    the load turns while a tip is on a fold that is no bound.

    On straight flanks W''' is 0, and second order says nothing. There maxima of W' and of
    `W' + eps Q'`, and likewise those with the support's force, lie no further apart than
    `eps max|Q'|`: extreme forces change by no more, the support is pulled on by no more
    than that over Phi'', and no place is further away than half a period.
    """
    Y = np.arange(_PLACES) / _PLACES - 0.5
    Y = np.append(Y, [at.data.phase[np.argmax(s * at.data.force)] for s in (1.0, -1.0)])
    Y = Y - np.round(Y)
    potential = _tabulated(at)
    of_tip = isinstance(potential, BristlePotential) and not _is_straight(potential)
    asked = _rest_of_tip if of_tip else _rest
    fixed = potential, np.asarray(at.eps)
    slope, bend, steep, sharp = in_chunks(asked, _PLACES + 2, fixed, (Y,))
    tops = slice(-2, None)
    largest = float(np.max(np.abs(slope)))
    place = at.eps * np.abs(bend[tops]) / np.maximum(np.abs(sharp[tops]), _STRAIGHT)
    place = np.minimum(place, min(largest / at.softest, 0.5))
    forces = at.eps * (np.abs(slope[tops]) + 0.5 * place * np.abs(bend[tops]))
    forces = np.minimum(forces, at.eps * largest)
    force = float(np.max(forces))
    carried = max(1.0, at.fastest * at.stiffest / at.softest - 1)
    late = float(np.max(at.fastest * forces / at.softest + carried * at.eps * place))
    shift = float(np.max(forces / at.softest + at.eps * place))
    late = max(late, at.apart(shift)) if at.is_behind(shift) else late
    flat = at.eps * at.softest / at.fastest
    inside = at.eps**2 * float(np.max(np.abs(slope) / np.maximum(np.abs(steep), flat)))
    share = at.eps * largest / at.rho
    slip = _SLIP * at.eps ** (1 + at.gamma) / float(np.max(np.abs(steep)))
    longer = share * min(at.fastest * at.speed * slip, _FELT * at.eps)
    in_z = max(late, inside) + longer
    moved = float(np.max(forces + at.stiffest * at.eps * place))
    told = Estimate(in_z, force, 1.0, "eps Q' at the steepest places (Lemma 2)")
    return HigherOrder(told, turns_on_folds(at, moved))


def _tabulated(at: Setting) -> AbstractPotential:
    """The potential in tables, whose program is there.

    Q of a sum is known as it is, and that of a straight bristle is 0 and no rounding.
    """
    potential = at.scene.potential
    if not isinstance(potential, BristlePotential) or _is_straight(potential):
        return potential
    return tabulated_potentials(potential, at.eps)[0]


def _is_straight(potential: BristlePotential) -> bool:
    return isinstance(potential.bristle, Homothetic | Linear)


def finite_speed(at: Setting) -> Estimate:
    """What viscosity adds to friction on the fastest slide: force and state beyond rho.

    From above: 3% more than the law says. NaN where the limit does not slide through a few
    wells.
    """
    plain = at.data._replace(change=np.zeros_like(at.data.change))
    found = predict_errors(plain, np.array([at.eps]), np.array([at.gamma]))
    in_z = _LAW * float(found["strip_excess"].errors[0, 0])
    law = found["strip_excess"].laws[0]
    return Estimate(in_z, in_z * at.stiffest, np.nan, f"law of a slide: {law.name}")
