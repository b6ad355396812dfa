"""The limit friction law: coefficients, and the dissipation potential."""

import dataclasses
from typing import Any

import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from .._checks import checked, kind_of, note_origin, require, require_x64, with_nan
from ..bristles import AbstractBristle
from ..coefficients import Coefficients, Condition, note_condition, with_errors
from ..effects import NapFlip, Noise
from ..profiles import AbstractSampled
from .admissibility import admissible_coefficients
from .composition import composed
from .potentials import AbstractPotential, BristlePotential, potential
from .scene import Scene

_LEFT_OUT: dict[Any, Condition] = {
    NapFlip: Condition("if the rod kept its nap", "`nap` has that of it turned over"),
    Noise: Condition("without noise", "`friction_curve` has that with it"),
}


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

    Of a scene with `effects.NapFlip` they are those of the rod if it kept its nap (`nap`
    has friction of it turned over), with `effects.Noise` those without noise
    (`friction_curve` has friction with it); tables of them say so.

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
            kind_of(scene_or_profile),
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
    for effect in getattr(scene_or_profile, "effects", ()):
        if type(effect) in _LEFT_OUT:
            note_condition(found, _LEFT_OUT[type(effect)])
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
