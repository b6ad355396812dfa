"""Inverse design of a bristle: the angle, or another number, for a wanted friction."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ..arguments import (
    Real,
    as_text,
    is_concrete,
    is_known,
    known_numbers,
    require,
    require_x64,
)
from ..bristles import AbstractBristle
from ..coefficients import coefficients_jit
from ..potentials import potential
from ..profiles import AbstractProfile
from ..programs import Program, room
from ..surroundings import with_nan
from .angle_fit import AngleFit
from .fit_status import FitStatus
from .free_parameter import FreeParameter, free_parameter, require_bounds, with_arrays
from .inverse import solve_targets
from .quantities import MEANING, QUANTITIES, Slopes
from .survey import survey

_ROOM = 8, 8  # smallest piece of a batch, and by how much the next size is larger
_MOST = 512  # targets side by side: 7 KB each of comparisons at every node


@Program
def _survey(free: FreeParameter, bristle, slopes, which, bounds):
    """The survey, and the intervals of number and quantity that it found."""
    low, high = free.interval(bristle, bounds)
    found = survey(free, bristle, slopes, which, low, high)
    value = jax.vmap(jax.vmap(lambda x: free.value(bristle, x)))
    admissible = jnp.sort(value(found.ends), axis=1)
    return found, admissible, jnp.stack([found.low, found.high], axis=1)


@Program
def _solve(free: FreeParameter, bristle, slopes, which, targets, seen):
    found = solve_targets(free, bristle, slopes, which, targets, seen)
    bristles = jax.vmap(lambda x: free.at(bristle, x))(found.x)
    value = jax.vmap(lambda x: free.value(bristle, x))
    roots = jnp.sort(jax.vmap(value)(found.roots), axis=1)
    return bristles, value(found.x), found.achieved, roots, found.code


def _in_sizes(target: Real, fit: Any) -> Any:
    """`fit` of targets in pieces of a few sizes, so that few programs are compiled."""
    targets = jnp.atleast_1d(target)
    count = targets.shape[0]
    size = min(room(count, *_ROOM), _MOST)
    padded = jnp.pad(targets, (0, -count % size), mode="edge")
    parts = [fit(padded[at : at + size]) for at in range(0, count, size)]

    def joined(*leaves):
        whole = jnp.concatenate(leaves)[:count] if len(leaves) > 1 else leaves[0][:count]
        return whole if target.ndim else whole[0]

    return jax.tree_util.tree_map(joined, *parts)


@with_nan
def fit_angle(
    profile: AbstractProfile,
    bristle: AbstractBristle,
    rho_plus: Any = None,
    rho_minus: Any = None,
    ratio: Any = None,
    difference: Any = None,
    free: str = "angle",
    bounds: Any = None,
) -> AngleFit:
    """The bristle on a surface that has a wanted friction, one number of it free.

    Exactly one of `rho_plus` (N, > 0), `rho_minus` (N, < 0), `ratio` = -rho_plus/rho_minus
    (> 0) and `difference` = rho_plus + rho_minus (N; how much harder the right is than the
    left) is given: a number, or an array of shape (n,), solved as a batch.

    `free`: which number: `"angle"`, for `AngularSpring` theta_lim at fixed length, or any
    other of the bristle by name, also a leaf of a `Custom` one or of a bristle of your own
    (`"energy_fn.alpha"`, `"numbers[0]"`). `bounds`: (low, high) of it. Without bounds:
    angles over all of their range, positive numbers from 1e-4 to 1e4 times what they are,
    other numbers up to 1e4 times that.

    Only the two extreme slopes of the surface enter. The intervals where the bristle is
    admissible are found first, then all extrema of the quantity in each, then every root
    between them by bracketed Newton, to rounding. Features of the quantity narrower than a
    hundredth of an interval can be missed.

    Returns an `AngleFit`: `.bristle .value .solutions .reachable .admissible .success
    .status .message .achieved .sensitivities`. Traceable: `jax.grad` of `.value` is the
    implicit derivative.

    Raises `ValueError` for no target or two, targets that are not finite, have another
    shape or the wrong sign, an unknown `free`, bounds out of range, and where no value in
    the bounds is admissible.
    """
    known = potential(profile, bristle)  # checks the kinds of the parts
    require_x64(known)
    name, target = _asked((rho_plus, rho_minus, ratio, difference))
    bristle = with_arrays(bristle)
    chosen = free_parameter(bristle, free)
    require_bounds(chosen, bounds)
    law = coefficients_jit(potential(profile, bristle))
    slopes = Slopes(law.omega_plus, law.omega_minus)
    _require_slopes(slopes)
    which = np.asarray(QUANTITIES.index(name))
    limits = jnp.asarray((np.nan, np.nan) if bounds is None else bounds, dtype=float)
    # Stopped here, not in the program: differentiated programs are compiled once more.
    still = jax.lax.stop_gradient((bristle, slopes))
    seen, admissible, reachable = _survey(chosen, *still, which, limits)
    bristles, value, achieved, roots, code = _in_sizes(
        target, lambda some: _solve(chosen, bristle, slopes, which, some, seen)
    )
    fit = AngleFit(
        bristles,
        value,
        achieved,
        target,
        roots,
        admissible,
        reachable,
        code,
        slopes,
        profile,
        free,
        name,
    )
    _require_admissible(fit, bounds)
    return fit


def _asked(given: tuple) -> tuple[str, Any]:
    """Name and value of the one target that is given, checked."""
    named = {k: v for k, v in zip(QUANTITIES, given, strict=True) if v is not None}
    allowed = f"exactly one of {', '.join(QUANTITIES)}"
    require(len(named) == 1, "targets", ", ".join(named) or "none", allowed)
    ((name, value),) = named.items()
    if not is_known(value):
        return name, jnp.asarray(value, dtype=float)
    array = known_numbers(value)
    meaning = f"{name} ({MEANING[name]})"
    needs = f"one number or an array of shape (n,), n > 0: {meaning}"
    numeric = array.dtype != object and array.ndim < 2 and array.size > 0
    require(numeric, name, value, needs)
    array = array.astype(float)
    require(np.all(np.isfinite(array)), name, array, f"finite numbers: {meaning}")
    if name == "rho_minus":
        require(np.all(array < 0), name, array, "rho_minus < 0")
    elif name != "difference":
        require(np.all(array > 0), name, array, f"{name} > 0")
    return name, jnp.asarray(array)


def _require_slopes(slopes: Slopes) -> None:
    if is_concrete(slopes):
        low, high = float(slopes.minus), float(slopes.plus)
        said = f"omega_minus = {low:.6g}, omega_plus = {high:.6g}"
        require(low < 0 < high, "profile", said, "omega_plus > 0 > omega_minus")


def _require_admissible(fit: AngleFit, bounds: Any) -> None:
    if not is_concrete(fit.code, fit.slopes):
        return
    none = np.all(np.asarray(fit.code) == int(FitStatus.INADMISSIBLE))
    low, high = float(fit.slopes.minus), float(fit.slopes.plus)
    where = "of its range" if bounds is None else f"in bounds = {as_text(bounds)}"
    needs = (
        f"some {fit.free} {where} with alpha != 0 and 1 + a omega > 0 on slopes "
        f"from {low:.6g} to {high:.6g}, but none is admissible"
    )
    require(not none, "bristle", type(fit.bristle).__name__, needs)
