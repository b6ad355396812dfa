"""Inverse design of a bristle: the angle, or another number, for a wanted friction."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from ..._checks import (
    Real,
    as_jax,
    as_text,
    is_concrete,
    is_known,
    known_numbers,
    require,
    require_flags,
    require_x64,
    with_nan,
)
from ..._compile import once_a_scene, padded_size, waiting
from ...bristles import AbstractBristle, swapped_text
from ...effects import AbstractEffect, Engine
from ...model import coefficients_jit, potential
from ...profiles import AbstractProfile
from ..common import (
    MEANING,
    QUANTITIES,
    FreeParameter,
    Slopes,
    effects_of_scene,
    free_parameter,
    require_bounds,
    with_arrays,
)
from .admissible import Admissible, survey
from .inverse import PulledParts, solve_targets
from .result import AngleFit, intervals_text
from .settings import SETTINGS
from .status import GOOD, FitStatus

_NO_BOUNDS = np.full(2, np.nan)


class _Range(NamedTuple):
    """A survey, and its intervals of the number and of the quantity (pieces, 2)."""

    seen: Admissible
    admissible: Real
    reachable: Real


@once_a_scene
def _survey(free: FreeParameter, bristle, slopes, which, bounds, pulling):
    """What is allowed, and bristles that pull and are not: two `_Range`."""
    low, high = free.interval(bristle, bounds)
    value = jax.vmap(jax.vmap(lambda x: free.value(bristle, x)))

    def ranges(seen: Admissible) -> _Range:
        admissible = jnp.sort(value(seen.ends), axis=1)
        return _Range(seen, admissible, jnp.stack([seen.low, seen.high], axis=1))

    both = survey(free, bristle, slopes, which, low, high, pulling)
    return ranges(both[0]), ranges(both[1])


class _Solved(NamedTuple):
    """Of each target, as `AngleFit` names them."""

    bristle: Any
    value: Real
    achieved: Real
    alpha: Real
    roots: Real
    code: Real


@once_a_scene
def _solve(free: FreeParameter, bristle, slopes, which, targets, seen):
    found = solve_targets(free, bristle, slopes, which, targets, seen)
    bristles = jax.vmap(lambda x: free.at(bristle, x))(found.x)
    value = jax.vmap(lambda x: free.value(bristle, x))
    roots = jnp.sort(jax.vmap(value)(found.roots), axis=1)
    return _Solved(bristles, value(found.x), found.achieved, found.alpha, roots, found.code)


def _in_sizes(target: Real, fit: Any) -> Any:
    """`fit` of targets in pieces of a few sizes, so that few programs are compiled."""
    by: Any = np if is_concrete(target) else jnp  # JAX compiles steps at each new shape
    targets = by.atleast_1d(by.asarray(target))
    count = targets.shape[0]
    size = min(padded_size(count, *SETTINGS.room), SETTINGS.side_by_side)
    padded = by.pad(targets, (0, -count % size), mode="edge")
    parts = [fit(padded[at : at + size]) for at in range(0, count, size)]

    def joined(*leaves: Any) -> Any:
        known = is_concrete(leaves)
        parts = [np.asarray(leaf) for leaf in leaves] if known else list(leaves)
        by: Any = np if known else jnp
        whole = by.concatenate(parts)[:count] if len(parts) > 1 else parts[0][:count]
        found = whole if target.ndim else whole[0]
        return as_jax(found) if known else found

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
    pulling: bool = False,
    effects: Sequence[AbstractEffect] = (),
    *,
    progress: bool = False,
) -> AngleFit:
    """The `bristle` on a surface, `profile`, that has a wanted friction, one number free.

    Exactly one of `rho_plus` (N, > 0), `rho_minus` (N, < 0), `ratio` = -rho_plus/rho_minus
    (> 0) and `difference` = rho_plus + rho_minus (N; how much harder the right is than the
    left) is given: a number, or an array of shape (n,), solved as a batch. It is met to 9
    digits at least, a difference to 9 digits of the larger force.

    `free`: which number: `"angle"`, for `AngularSpring` theta_lim at fixed length, or any
    other of the bristle by name, also a leaf of a `Custom` one or of a bristle of your own
    (`"energy_fn.alpha"`, `"numbers[0]"`). `bounds`: (low, high) of it. Without bounds:
    angles over all of their range, positive numbers from 1e-4 to 1e4 times what they are,
    other numbers up to 1e4 times that. Of bounds that reach further than a bristle can
    follow the surface the admissible part is searched.

    Bristles press on the surface, alpha = F'(0) > 0. The paper's formulas hold for alpha
    < 0 too, where the bristle pulls: `pulling=True` returns such solutions as well. Without
    it, a target that only they reach has the status `PULLS`.

    `effects`: of the scene, as in `fit_profile`: forces are those of all bristles of an
    array, a ratio is that of one; with `NapFlip`, `.nap` and `.message` say for which
    critical loads the rod turns over.

    `progress`: a line on standard error where it takes more than two seconds.

    Only the two extreme slopes of the surface enter. The intervals where the bristle is
    admissible are found first, then all extrema of the quantity in each, then every root
    between them by bracketed Newton, to rounding. Features of the quantity narrower than a
    hundredth of an interval can be missed.

    Returns an `AngleFit`: `.bristle .value .solutions .reachable .admissible .success
    .status .message .achieved .alpha .sensitivities`. Traceable: `jax.grad` of `.value` is
    the implicit derivative.

    Raises `ValueError` for no target or two, targets that are not finite, have another
    shape or the wrong sign, an unknown `free`, bounds out of the number's range, where no
    value in the bounds is admissible, or all that are pull, and for other effects, and tips
    at different phases of bristles that lean.

    >>> fx.fit_angle(scene.profile, scene.bristle, ratio=1.5)
    AngleFit(angle=1.10715: ratio = 1.5: found, angle = 1.10715)
    """
    require_flags(pulling=pulling, progress=progress)
    require_x64(potential(profile, bristle))  # which checks the kinds of the parts
    name, wanted = _asked((rho_plus, rho_minus, ratio, difference))
    bristle = with_arrays(bristle)
    chosen = free_parameter(bristle, free)
    require_bounds(chosen, bristle, bounds)
    scene = effects_of_scene(effects, Engine.DESIGN, [bristle])
    with waiting("fit_angle", progress) as tell:
        tell("slopes of the surface")
        law = coefficients_jit(potential(scene.surface(profile), bristle))
        slopes = Slopes(law.omega_plus, law.omega_minus)
        _require_slopes(slopes)
        which, target = np.asarray(QUANTITIES.index(name)), scene.of_one(wanted, name)
        limits = _NO_BOUNDS if bounds is None else jnp.asarray(bounds, dtype=float)
        # Stopped here, not in the program: differentiated programs are compiled once more.
        still = jax.lax.stop_gradient((bristle, slopes))
        fixed = chosen, *still, which
        flag = np.asarray(pulling)
        tell("values that are allowed")
        allowed, others = _survey(*fixed, limits, flag)
        tell("values that are asked for")
        found = _in_sizes(
            target,
            lambda some: _solve(chosen, bristle, slopes, which, some, allowed.seen),
        )
        aims = jax.lax.stop_gradient(target)
        code, pulled = _with_pulled(found.code, fixed, aims, others.seen)
    fit = AngleFit(
        found.bristle,
        found.value,
        scene.of_all(found.achieved, name),
        scene.of_all(found.alpha),
        wanted,
        found.roots,
        allowed.admissible,
        scene.of_all(allowed.reachable, name),
        code,
        pulled._replace(alpha=scene.of_all(pulled.alpha)),
        slopes,
        profile,
        free,
        name,
        bool(pulling),
        scene,
    )
    known = is_concrete(code, slopes, allowed)
    if known and np.isnan(np.asarray(allowed.admissible)).all():
        unbounded = None if bounds is None else _survey(*fixed, _NO_BOUNDS, flag)[0]
        raise ValueError(_none_admissible(fit, bristle, bounds, others, unbounded))
    return fit


def _with_pulled(
    code: Any, asked: tuple, targets: Any, seen: Admissible
) -> tuple[Any, PulledParts]:
    """Codes where bristles that pull, and may not, reach a target, and the nearest of them.

    The same program as for those that press. Where all are found it is not run.
    """
    none = as_jax(np.full(targets.shape, np.nan))
    failed = (int(FitStatus.UNREACHABLE), int(FitStatus.INADMISSIBLE))
    if is_concrete(code) and not np.isin(np.asarray(code), failed).any():
        return code, PulledParts(none, none)
    found = _in_sizes(targets, lambda some: _solve(*asked, some, seen))
    known = is_concrete(code, found)
    by, exact = (np, as_jax) if known else (jnp, jnp.asarray)
    good = np.array([int(status) for status in GOOD])
    pulls = by.isin(found.code, good) & by.isin(code, np.array(failed))
    nearest = [exact(by.where(pulls, one, none)) for one in (found.value, found.alpha)]
    return exact(by.where(pulls, int(FitStatus.PULLS), code)), PulledParts(*nearest)


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


def _none_admissible(
    fit: AngleFit,
    bristle: AbstractBristle,
    bounds: Any,
    others: _Range,
    unbounded: _Range | None,
) -> str:
    """Why no value is allowed: what bristles must, what pulls, and where others are."""
    low, high = float(fit.slopes.minus), float(fit.slopes.plus)
    force = "alpha != 0" if fit.pulling else "alpha > 0"
    hold = f"{force} and 1 + a omega > 0 on slopes from {low:.6g} to {high:.6g}"
    known = "" if unbounded is None else intervals_text(unbounded.admissible)
    why = _why_none(fit, bristle, others)
    if known:
        return (
            f"bounds = {as_text(bounds)}: needs a part of {known}, where {fit.free} has "
            f"{hold}, but in the bounds {why}"
        )
    kind = type(bristle).__name__
    return f"bristle = {kind!r}: needs some {fit.free} with {hold}, but {why}"


def _why_none(fit: AngleFit, bristle: AbstractBristle, others: _Range) -> str:
    pull = intervals_text(others.admissible)
    if not pull:
        return "none is admissible"
    parts = [
        f"every admissible one pulls, alpha < 0, {fit.free} in {pull}: pulling=True "
        "(--pulling in the shell) allows that",
        swapped_text(bristle),
    ]
    return "; ".join(part for part in parts if part)
