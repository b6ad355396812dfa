"""The limit friction law: coefficients, dissipation potential, dual form."""

import dataclasses
from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from .._checks import Real, checked, note_origin, require, require_x64, with_nan
from ..bristles import AbstractBristle
from ..coefficients import Coefficients, with_errors
from ..profiles import AbstractSampled
from .admissibility import admissible_coefficients
from .composition import composed
from .potentials import AbstractPotential, BristlePotential, potential
from .scene import Scene
from .settings import SETTINGS

_SPACING = float(np.finfo(np.float64).eps)


@with_nan
def friction(scene_or_profile: Any, bristle: AbstractBristle | None = None) -> Coefficients:
    """Friction coefficients of a scene, or of a profile and a bristle.

    `friction(scene)` or `friction(profile, bristle)`; no trajectory is built.
    `scene_or_profile`: the first of either.

    Returns `Coefficients` (Lemmas 2 and 3): `.rho_plus` and `.rho_minus` in N, and with a
    bristle `.alpha` in N, `.a`, `.omega_plus`, `.mu_plus`, `.normal_plus` (N) and their
    like to the left, which have no unit where none is said. Scalars, differentiable in
    every parameter of the parts (`jax.grad` through `rho_plus`). Of a surface known by
    samples `omega_plus_error`, `rho_plus_error` and the like say how well the samples
    determine them.

    Raises `ValueError` naming the hypothesis of the paper that fails: `omega_plus > 0 >
    omega_minus`, `alpha != 0`, `1 + a omega > 0` at both ends, the bristle's own bounds.
    Traced values cannot be looked at: under `jit` and `vmap` nothing is checked, and what
    an inadmissible bristle gives means nothing (`design_map` has NaN there).

    >>> law = fx.friction(scene)
    >>> print(f"{law.rho_plus:.4f} N to the right, {law.rho_minus:.4f} N to the left")
    0.1204 N to the right, -0.0879 N to the left
    """
    if bristle is None:
        require(
            hasattr(scene_or_profile, "potential"),
            "friction(...)",
            type(scene_or_profile).__name__,
            "a Scene, or a profile and a bristle",
        )
        known = isinstance(scene_or_profile, Scene)
        scene = composed(scene_or_profile) if known else scene_or_profile
        wiggle = checked(scene.potential)
    else:
        wiggle = potential(scene_or_profile, bristle)
    require_x64(wiggle)
    found = _with_errors_of_samples(wiggle, admissible_coefficients(wiggle))
    # A copy: a potential's own coefficients are a note on it, which must not hold it.
    found = dataclasses.replace(found)
    note_origin(found, wiggle)
    return found


def _with_errors_of_samples(wiggle: AbstractPotential, found: Coefficients) -> Coefficients:
    profile = wiggle.profile if isinstance(wiggle, BristlePotential) else None
    known = profile.slope_errors() if isinstance(profile, AbstractSampled) else None
    if known is None:
        return found
    found = with_errors(
        found, jnp.asarray(known.error_plus), jnp.asarray(known.error_minus)
    )
    taken = known.taken_plus, known.taken_minus
    if not any(taken):
        return found
    plus, minus = map(jnp.asarray, taken)
    return dataclasses.replace(found, omega_plus_taken=plus, omega_minus_taken=minus)


def dissipation_potential(
    rho_plus: Float[ArrayLike, ""],
    rho_minus: Float[ArrayLike, ""],
    v: Float[Array, "*shape"],
) -> Float[Array, "*shape"]:
    """`R(v)` (eq. 2.2): `rho_plus v` for v >= 0, `rho_minus v` for v <= 0."""
    return jnp.where(v >= 0, rho_plus * v, rho_minus * v)


def dual_dissipation(potential: AbstractPotential, xi: Real) -> Real:
    """`K(xi) = int_0^1 |xi - W'(Y)| dY` in N (eq. 5.5), to rounding.

    In the tip coordinate the integrand is `|xi (1 + a w') - alpha w'|`, whose inside is
    the derivative of `H = xi (y + a w) - alpha w`. So K is the variation of H: summed over
    a grid that holds the inflections of H, so that H turns once in a cell at most, with
    the few cells in which it does split at the turning point.
    """
    if isinstance(potential, BristlePotential):
        a, alpha, profile = potential.a(), potential.alpha(), potential.profile

        def primitive(y: Real) -> Real:
            w = profile(y)
            return xi * (y + a * w) - alpha * w
    else:

        def primitive(y: Real) -> Real:
            return xi * y - potential.W(y)

    slope = jax.grad(primitive)
    edges = _with_inflections(slope, 2 * potential.points)
    values, slopes = jax.vmap(jax.value_and_grad(primitive))(edges)

    def variation(
        left: Array,
        right: Array,
        start: Array,
        end: Array,
        slope_start: Array,
        slope_end: Array,
    ) -> Array:
        turns = slope_start * slope_end < 0
        share = slope_start / jnp.where(turns, slope_start - slope_end, 1.0)
        secant = left + (right - left) * jnp.clip(share, 0.0, 1.0)

        def newton(_: Any, y: Real) -> Real:
            value, bend = jax.jvp(slope, (y,), (jnp.ones_like(y),))
            return jnp.clip(y - value / jnp.where(bend == 0, 1.0, bend), left, right)

        # H' is zero at the turn, so what is left of its place enters squared.
        place = jax.lax.stop_gradient(jax.lax.fori_loop(0, SETTINGS.newton, newton, secant))
        turn = primitive(place)
        split = jnp.abs(turn - start) + jnp.abs(end - turn)
        return jnp.where(turns, split, jnp.abs(end - start))

    pieces = jax.vmap(variation)(
        edges[:-1], edges[1:], values[:-1], values[1:], slopes[:-1], slopes[1:]
    )
    return jnp.sum(pieces)


def _with_inflections(slope: Callable[[Real], Real], cells: int) -> Array:
    """Grid of a period, each cell halved: where `slope'` has its zero, if it has one."""
    edges = jnp.arange(cells + 1) / cells
    bend = jax.grad(slope)
    bends = jax.vmap(bend)(edges)
    turns = bends[:-1] * bends[1:] < 0
    share = bends[:-1] / jnp.where(turns, bends[:-1] - bends[1:], 1.0)
    middle = edges[:-1] + jnp.where(turns, share, 0.5) / cells
    inner = jnp.stack([edges[:-1], middle], axis=1).ravel()
    return jax.lax.stop_gradient(jnp.append(inner, 1.0))


def limit_dissipation(
    potential: AbstractPotential,
    found: Coefficients,
    v: Float[ArrayLike, ""],
    xi: Float[ArrayLike, ""],
    slack: Real | float = 0.0,
    load: Real | float = 0.0,
) -> Real:
    """`M(v, xi) = |v| K(xi) + chi(xi)` (eq. 5.4), infinite outside the rho interval.

    On a slide xi = l - Phi'(z) is rho but for rounding, so the interval is wider by
    1e-10 (rho_plus - rho_minus), and by `slack` N. `load`: l in N, of which xi is what is
    left: eight spacings of floats at l and at Phi' = l - xi are added, which are more than
    that where l is 1e5 rho or larger. From xi alone nobody can tell: without `load`, and
    for a Phi' that is itself a difference of large forces, `slack` has to. K is that of
    the nearest xi inside.
    """
    size = jnp.maximum(jnp.abs(load), jnp.abs(load - xi))
    lost = jnp.where(jnp.asarray(load) == 0, 0.0, SETTINGS.spacings * _SPACING * size)
    slack = slack + lost + SETTINGS.slack * (found.rho_plus - found.rho_minus)
    inside = (xi >= found.rho_minus - slack) & (xi <= found.rho_plus + slack)
    held = jnp.clip(xi, found.rho_minus, found.rho_plus)
    return jnp.where(inside, jnp.abs(v) * dual_dissipation(potential, held), jnp.inf)
