"""Load given as a function."""

from collections.abc import Callable
from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import (
    Real,
    as_jax,
    as_real,
    in_64_bits,
    is_known,
    known_numbers,
    require,
)
from .completeness import (
    require_complete,
    require_rate,
    turns_elsewhere,
    warn_of_doubt,
    warn_of_traces,
)
from .course import Course, course_of
from .load import AbstractLoad, listed_turning_points
from .settings import SETTINGS


class Custom(AbstractLoad):
    """`l(t) = fn(t)`, continuous and piecewise C^1.

    `fn`: s to N, scalar to scalar, written with `jax.numpy`. `turning_points`: all times
    at which `l'` changes sign, shape (n,); none are needed (`listed`: the same, where a
    load is built anew of its parts).

    A scene finds what the load does on [0, duration]: turning points, kinks, steep places.
    Interval arithmetic on the program of `fn` bounds l, l' and l'' over stretches that are
    cut until the bounds prove that the load rises, falls or rests there: no pulse hides,
    however short, down to 64 spacings of floats at `duration`. Where `fn` uses what has no
    bounds (`lax.while_loop`; callbacks, to which `jax.custom_jvp` gives a derivative) or
    needs too many stretches, 65536 stretches of [0, duration] (fewer where `fn` takes
    long) are looked at in four places each, and closer where they surprise; then an
    `UnprovedLoad` warning says how short a pulse may have gone unseen.

    Where numbers of `fn`, or the duration, are traced while the scene is built, nothing
    can be found, and an `UnprovedLoad` warning says so where no turning points are listed:
    list them, or trace numbers of a scene that is built (`equinox.tree_at`,
    `equinox.filter_grad`). A load that turns elsewhere, as 4096 samples see it, gives NaN
    then, with the status TOO_MANY_TURNS (of limits NOT_FINITE); and so does one of which
    numbers, or the duration, were changed after the scene was built.
    Derivatives by numbers of `fn` hold its turning points where they are, which is right
    where l' = 0 there.

    Raises `ValueError` for times that are not finite and increasing, and for `fn` without
    a derivative by `jax.jvp`. A scene raises one for a load that jumps or is not finite,
    for one that turns more often than can be looked at (listed or not), and where turning
    points are listed but some that were found are not among them; listed times at which
    it does not turn do no harm.

    >>> import jax.numpy as jnp
    >>> swept = scene.replace(load=fx.loads.Custom(lambda t: jnp.sin(t**2)))
    >>> print(swept.turning_points()[:3].round(4))
    [1.2533 2.1708 2.8025]
    """

    _stored: ClassVar = {"turning_points": "listed"}

    fn: Callable[[Real], Real]
    listed: Float[Array, " n"] = eqx.field(converter=as_real)
    found: Float[Array, " m"] | None = eqx.field(init=False)
    steepest: Real | None = eqx.field(init=False)
    until: Real | None = eqx.field(init=False)

    def __init__(self, fn: Callable[[Real], Real], turning_points=None, *, listed=()):
        self.fn = fn
        self.listed = listed if turning_points is None else turning_points
        self.found = self.steepest = self.until = None

    def __check_init__(self):
        require_rate("load.fn", self.fn)
        if not is_known(self.listed):
            return
        times = known_numbers(self.listed)
        require(times.ndim == 1, "load.turning_points", self.listed, "times, shape (n,)")
        increasing = np.all(np.isfinite(times)) and np.all(np.diff(times) > 0)
        require(increasing, "load.turning_points", times, "finite, increasing times")

    def __call__(self, t: Real) -> Real:
        return jnp.asarray(self.fn(t))

    def prepared(self, duration: Real) -> "Custom":
        """With the turning points and kinks of [0, duration] that are found there."""
        if not in_64_bits():
            return self
        none = self.listed.size == 0  # as good as known, though JAX traces it
        if not is_known(self.fn, () if none else self.listed, duration):
            if none and self.found is None:
                warn_of_traces("the duration is" if is_known(self.fn) else "numbers are")
            return self
        course = course_of(self.fn, float(duration))
        warn_of_doubt("load.fn", course, "write fn")
        times = self._times(course, float(duration))
        with jax.ensure_compile_time_eval():
            known = tuple(map(as_jax, (times, course.steepest, float(duration))))
        return eqx.tree_at(_unknown, self, known, is_leaf=lambda leaf: leaf is None)

    def turning_count(self, duration: float) -> int:
        ready = self.until is not None and duration <= self.until
        load = self if ready else self.prepared(jnp.asarray(duration))
        return int((load.listed if load.found is None else load.found).shape[0])

    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        if self.found is None or self.until is None:
            wrong, times = turns_elsewhere(self, self.listed, duration), self.listed
        else:
            wrong, times = duration > (1 + SETTINGS.later) * self.until, self.found
            if jax.tree_util.tree_leaves(eqx.filter(self.fn, eqx.is_array)):
                wrong |= turns_elsewhere(self, self.found, duration)
        return jnp.where(wrong, jnp.nan, listed_turning_points(times, duration, count))

    def _times(self, course: Course, duration: float) -> np.ndarray:
        """Where pieces end: listed times, or turning points that were found; and kinks."""
        if self.listed.size == 0:
            return np.union1d(course.turns, course.kinks)
        listed = known_numbers(self.listed)
        inside = listed[(listed > 0) & (listed < duration)]
        none = ", or none: then they are found"
        require_complete("load.turning_points", course, inside, none)
        apart = np.abs(course.kinks[:, None] - inside) > SETTINGS.same * duration
        return np.union1d(listed, course.kinks[apart.all(axis=1)])


def _unknown(load: Custom) -> tuple:
    return load.found, load.steepest, load.until
