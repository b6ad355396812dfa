"""What a surface profile is, and the check that it is one."""

import abc
from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from .._checks import (
    Part,
    Real,
    in_64_bits,
    is_concrete,
    is_foreign,
    require,
    require_function,
    require_whole,
    with_nan,
)
from .._compile import Interpreted, in_chunks
from .settings import SETTINGS


class AbstractProfile(Part):
    """The profile `w`: 1-periodic and C^2, a surface of height `eps w(x/eps)`.

    An implementer keeps three rules:

    1. `__call__(y)` takes arrays of any shape and reduces `y` to one period itself, so
       that no digits are lost at y = 1e8.
    2. It is twice differentiable by `jax.jvp` everywhere.
    3. `points` samples a period resolve `w'`; it is static.

    Of a class of your own they are checked where it is made, as `Custom` is.

    >>> print(scene.profile(np.array([0.0, 0.25, 0.5, 0.75])).round(4))
    [ 0.      0.0159 -0.     -0.0159]
    """

    def __check_init__(self):
        if is_foreign(self):
            _require_rules(self)

    @abc.abstractmethod
    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        """Height `w(y)` in periods, at tip coordinate `y` in periods."""

    @property
    @abc.abstractmethod
    def points(self) -> int:
        """How many samples a period resolve `w'`."""


@Interpreted
def _derivatives(fn: Callable, y):
    first = jax.vmap(jax.grad(fn))
    second = jax.vmap(jax.grad(jax.grad(fn)))
    third = jax.vmap(jax.grad(jax.grad(jax.grad(fn))))
    return jax.vmap(fn)(y), first(y), second(y), third(y)


@with_nan
def require_smooth(name: str, fn: Callable[[Real], Real], points: int) -> None:
    """Check that `fn` on [0, 1) repeats as a C^2 function (hypothesis of Section 3).

    Looks at the seam from both sides and, between neighbouring samples, for jumps of
    `w, w', w''` larger than their derivatives explain.

    Raises `ValueError` naming the derivative that jumps, where, and by how much.
    """
    if not is_concrete(fn) or not in_64_bits():
        return
    inside = SETTINGS.inside
    y = jnp.asarray(np.concatenate([np.arange(points) / points, [1.0 - inside]]))
    values = in_chunks(_derivatives, SETTINGS.together, (fn,), (np.asarray(y),))
    for value in values[:3]:
        require(np.all(np.isfinite(value)), name, "not finite", "finite w, w', w''")
    sizes = [max(float(np.max(np.abs(v))), 1e-300) for v in values]
    require(np.ptp(values[0]) > 0, name, "constant", "a profile that is not constant")
    for order, label in enumerate(("w", "w'", "w''")):
        value, slope, size = values[order], values[order + 1], sizes[order]
        seam = float(abs(value[-1] + inside * slope[-1] - value[0]))
        require(
            seam <= SETTINGS.seam * (size + inside * sizes[order + 1]),
            name,
            f"{label} jumps by {seam:.3g} at the seam y = 0",
            "a 1-periodic C^2 function",
        )
        jumps, allowed = _steps(value[:-1], slope[:-1])
        worst = int(np.argmax(jumps - allowed))
        require(
            jumps[worst] <= allowed[worst] + SETTINGS.jump * size,
            name,
            f"{label} jumps by {jumps[worst]:.3g} near y = {worst / points:.4g}",
            "a 1-periodic C^2 function",
        )


@Interpreted
def _heights(profile: AbstractProfile, y: Array) -> Array:
    return jax.vmap(profile)(y)


@with_nan
def _require_rules(profile: AbstractProfile) -> None:
    """Check the rules of a profile, of one that nobody knows."""
    kind = f"profile: {type(profile).__name__}"
    require_function(f"{kind}.__call__", profile, "a function of y")
    require_whole(f"{kind}.points", profile.points, 16)
    require_smooth(f"{kind}.__call__", profile, profile.points)
    if not is_concrete(profile) or not in_64_bits():
        return
    y = (np.arange(SETTINGS.places) + 0.1) / SETTINGS.places
    inside, before, after = (_heights(profile, y + period) for period in (0.0, -1.0, 1.0))
    off = float(np.max(np.abs([before - inside, after - inside])))
    same = off <= SETTINGS.seam * float(np.max(np.abs(inside)))
    known = f"w(y) and w(y + 1) are {off:.3g} apart"
    require(same, f"{kind}.__call__", known, "a function that reduces y to one period")


def _steps(value: np.ndarray, slope: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What the slope leaves unexplained of each step between samples, and how much may.

    The trapezoid of a slope that is itself continuous, or jumps, errs by less than the
    slope varies nearby. Where it is unbounded (|y|^2.5 has no third derivative) any step
    is allowed.
    """
    width = 1 / value.size
    slope = np.where(np.isfinite(slope), slope, np.nan)
    mean = 0.5 * (slope + np.roll(slope, -1))
    steps = np.abs(np.roll(value, -1) - value - width * mean)
    change = np.abs(np.roll(slope, -1) - slope)
    nearby = np.maximum(change, np.maximum(np.roll(change, 1), np.roll(change, -1)))
    unknown = np.isnan(steps) | np.isnan(nearby)
    return np.where(unknown, 0.0, steps), np.where(unknown, 0.0, width * nearby)
