"""Whether the turning points that a load states are all that it has."""

import warnings
from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from .._checks import (
    ByIdentity,
    Real,
    as_plain,
    eagerly,
    in_64_bits,
    is_concrete,
    is_foreign,
    is_known,
    kind_of,
    real_struct,
    require,
    require_function,
    require_whole,
)
from .._compile import Interpreted
from .course import Course, course_of
from .settings import SETTINGS

_LOOKED_AT = ByIdentity()  # until when, in s


class UnprovedLoad(UserWarning):
    """A load may turn where nobody has looked.

    >>> import jax, warnings
    >>> wrap = lambda t: jax.lax.while_loop(lambda x: x > 1, lambda x: x - 1, t)
    >>> with warnings.catch_warnings(record=True, action="always") as told:
    ...     pulled = scene.replace(load=fx.loads.Custom(wrap), duration=0.9)
    >>> print(told[0].message)
    load.fn: while has no bounds, so a pulse of less than ... s may have gone unseen; ...
    """


def require_rate(name: str, fn: Callable[[Real], Real]) -> None:
    """Check that `fn` is a function of t with a slope.

    Callbacks and functions with `jax.custom_vjp` have none.
    """
    require_function(name, fn, "a function of t", smooth=False)

    def rate(t: Real) -> tuple[Real, Real]:
        return jax.jvp(lambda t: jnp.asarray(fn(t), float), (t,), (jnp.ones_like(t),))

    try:
        jax.eval_shape(rate, real_struct())
    except (TypeError, ValueError, NotImplementedError) as error:
        known = f"without jax.jvp, as {str(error).splitlines()[0]}"
        mend = "a function of t that jax.jvp can differentiate"
        require(False, name, known, f"{mend}; jax.custom_jvp gives a callback a slope")


def warn_of_doubt(name: str, course: Course, written: str) -> None:
    """Say how short a pulse may have gone unseen, and how a load is `written` instead."""
    if not course.unproved:
        return
    share = f"a pulse of less than {course.hidden:.3g} s may have gone unseen"
    mend = f"{written} with functions of jax.numpy, or as a PiecewiseLinear load"
    text = f"{name}: {course.unproved}, so {share}; {mend}"
    warnings.warn(text, UnprovedLoad, stacklevel=4)


def warn_of_traces(what: str) -> None:
    """Say that no turning points were found of a function, as something is traced."""
    unknown = "turning points cannot be found, and where it turns all results are NaN"
    mend = "list turning_points, or trace numbers of a scene that is built"
    how = "(equinox.tree_at, equinox.filter_grad)"
    text = f"load.fn: {what} traced, so {unknown}; {mend} {how}"
    warnings.warn(text, UnprovedLoad, stacklevel=4)


def require_complete(
    name: str, course: Course, listed: np.ndarray, otherwise: str = ""
) -> None:
    """Check that a listed time is at each turning point: as high, and on its flanks."""
    turns = course.turns
    before = np.concatenate([[-np.inf], turns[:-1]])
    after = np.append(turns[1:], np.inf)
    missing = []
    for turn, low, high in zip(turns, before, after, strict=True):
        near = listed[(listed > low) & (listed < high)]
        heights = course.values(np.append(near, turn))
        if not np.any(np.abs(heights[:-1] - heights[-1]) <= SETTINGS.same * course.size):
            missing.append(turn)
    some = ", ".join(f"{turn:.9g}" for turn in missing[:4])
    more = f" and {len(missing) - 4} more" if len(missing) > 4 else ""
    allowed = f"every time at which l' changes sign{otherwise}"
    require(not missing, name, f"without {some}{more}", allowed)


def turns_elsewhere(
    load: Callable[[Real], Real], turns: Float[Array, " n"], duration: Real
) -> Bool[Array, ""]:
    """Whether samples of a load go both ways between two of these times, traceable."""
    times = duration * jnp.linspace(0.0, 1.0, SETTINGS.samples)
    values = jax.lax.stop_gradient(jax.vmap(load)(times))
    steps, noise = jnp.diff(values), SETTINGS.other_way * jnp.max(jnp.abs(values))
    piece = jnp.searchsorted(turns, times, side="right")
    inside = piece[1:] == piece[:-1]
    rooms = turns.shape[0] + 1

    def some(which: Bool[Array, " n"]) -> Bool[Array, " pieces"]:
        return jnp.zeros(rooms, dtype=bool).at[piece[1:]].max(which & inside)

    return jnp.any(some(steps > noise) & some(steps < -noise))


def require_methods(load: Any) -> None:
    """Check that JAX can trace a load of a foreign class, and its times are an array."""
    kind = f"load: {type(load).__name__}"
    require_rate(f"{kind}.__call__", load)
    name, allowed = f"{kind}.turning_points", "times, shape (count,)"
    try:
        found = jax.eval_shape(lambda end: load.turning_points(end, 2), real_struct())
    except jax.errors.JAXTypeError:
        needs = f"{allowed}, written with jax.numpy"
        require(False, name, load.turning_points, needs)
    shape = getattr(found, "shape", kind_of(found))
    require(shape == (2,), name, f"{shape} for a count of 2", allowed)


@Interpreted
def _stated(load: Any, duration: Array, count: int) -> Array:
    return load.turning_points(duration, count)


def require_stated(load: Any, duration: Any) -> None:
    """Check turning points that a load of a foreign class states, as `Custom` does listed
    ones; once for the same duration."""
    if not in_64_bits() or not is_known(load, duration):
        return
    end, kind = float(duration), f"load: {type(load).__name__}"
    if _LOOKED_AT.get(load) == end:
        return
    with eagerly(load, duration):
        count = as_plain(load.turning_count(end))
        require_whole(f"{kind}.turning_count", count, 0)
        if count > SETTINGS.most_stated:
            return  # the scene refuses it, or has no room for it
        try:
            course = course_of(load, end)
        except ValueError as problem:
            text = str(problem).replace("load.fn", f"{kind}.__call__", 1)
            raise ValueError(text) from None
        times = _stated(load, np.asarray(end), count)
    warn_of_doubt(f"{kind}.__call__", course, "write it")
    inside = times[(times > 0) & (times < end)]
    require_complete(f"{kind}.turning_points", course, inside)
    _LOOKED_AT.put(load, end)


def turning_points_of(load: Any, duration: Real, count: int) -> Float[Array, " count"]:
    """Turning points of any load; NaN where samples see a traced foreign one turn
    elsewhere."""
    times = load.turning_points(duration, count)
    if not is_foreign(load) or is_concrete(load, duration):
        return times
    return jnp.where(turns_elsewhere(load, times, duration), jnp.nan, times)
