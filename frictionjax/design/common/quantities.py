"""What a designer asks of a bristle: its coefficients on given slopes, and its limits."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp

from ..._checks import Real
from ...bristles import AbstractBristle, AngularSpring
from ...numerics import periodic_extrema, slope_of
from ...profiles import AbstractProfile
from .settings import SETTINGS

QUANTITIES = ("rho_plus", "rho_minus", "ratio", "difference")
MEANING = {
    "rho_plus": "N",
    "rho_minus": "N",
    "ratio": "-rho_plus/rho_minus",
    "difference": "rho_plus + rho_minus, N",
}


class Slopes(NamedTuple):
    """Extreme slopes of a surface: all that coefficients see of it."""

    plus: Real
    minus: Real


def slopes_of(profile: AbstractProfile, twice: bool = True) -> Slopes:
    """`omega_plus`, `omega_minus` of a profile, traceable and differentiable.

    Not `twice`: once, with two derivatives less to trace.
    """
    found = periodic_extrema(slope_of(profile), profile.points, twice)
    return Slopes(found.max, found.min)


class OnSlopes(NamedTuple):
    """A bristle on a surface with given extreme slopes.

    `margin`: the least of what has to be positive (eq. 3.22 at eps = 0, the bristle's own
    bounds on slopes), in units of slope; NaN where a number is not finite.
    """

    rho_plus: Real
    rho_minus: Real
    alpha: Real
    margin: Real


def _slope(fn: Any, x: Real) -> Real:
    return jax.jvp(fn, (x,), (jnp.ones_like(x),))[1]


def on_slopes(bristle: AbstractBristle, slopes: Slopes) -> OnSlopes:
    """Coefficients (Lemma 2, Lemma 3) and margin; nothing of the surface is scanned."""
    zero = jnp.zeros(())
    alpha, a = _slope(bristle.energy, zero), _slope(bristle.offset, zero)
    stretch_plus, stretch_minus = 1 + a * slopes.plus, 1 + a * slopes.minus
    mu_plus, mu_minus = slopes.plus / stretch_plus, slopes.minus / stretch_minus
    bounds = bristle.slope_bounds()
    gaps = (stretch_plus, stretch_minus, bounds.upper - slopes.plus)
    margin = jnp.minimum(jnp.minimum(*gaps[:2]), gaps[2])
    margin = jnp.minimum(margin, slopes.minus - bounds.lower)
    if isinstance(bristle, AngularSpring):  # its constructor's theta_lim > theta_rest
        margin = jnp.minimum(margin, bristle.limit_angle - bristle.rest_angle)
    return OnSlopes(
        rho_plus=jnp.where(alpha > 0, alpha * mu_plus, alpha * mu_minus),
        rho_minus=jnp.where(alpha > 0, alpha * mu_minus, alpha * mu_plus),
        alpha=alpha,
        margin=margin,
    )


def quantity_of(law: Any, which: Any) -> Real:
    """The quantity numbered as in `TRACE_QUANTITIES`; `which` may be traced."""
    plus, minus = law.rho_plus, law.rho_minus
    return jnp.stack([plus, minus, -plus / minus, plus + minus])[which]


def side_of(bristle: AbstractBristle, found: OnSlopes) -> Real:
    """Sign of alpha where the bristle is admissible, else 0.

    alpha counts as 0 within its own rounding, as in `require_admissible`.
    """
    curvature = _slope(lambda eta: _slope(bristle.energy, eta), jnp.zeros(()))
    noise = SETTINGS.no_force * jnp.abs(curvature) * getattr(bristle, "height", 0.0)
    presses = jnp.abs(found.alpha) > noise
    known = jnp.isfinite(found.rho_plus) & jnp.isfinite(found.rho_minus)
    good = presses & known & (found.margin > 0)
    return jnp.where(good, jnp.sign(found.alpha), 0.0)
