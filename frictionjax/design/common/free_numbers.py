"""The number of a bristle that a design is free to choose, by name, and its range."""

from collections.abc import Sequence
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..._checks import Real, as_text, is_known, known_numbers, require
from ...bristles import AbstractBristle, AngularSpring
from .settings import SETTINGS

_RIGHT = 0.5 * np.pi

# Of a rod: it is as long as its height at least, and near theta_lim = 0 hardly longer.
_OF_RODS = {"height": "limit_by_height", "length": "limit_by_length"}


class FreeParameter(eqx.Module):
    """One number of a bristle, and the coordinate `x` in which it is looked for.

    `kind` says which: the number itself (`angle`), its logarithm (`positive`), `asinh` of
    it (`line`), or theta_lim, for the height and the length of an angular spring: near
    theta_lim = 0 a millionth of a height is a thousandth of an angle. `leaf`, `entry`:
    place of the number among the bristle's leaves, None for theta_lim itself.
    """

    name: str = eqx.field(static=True)
    kind: str = eqx.field(static=True)
    leaf: int | None = eqx.field(static=True)
    entry: int | None = eqx.field(static=True)

    def now(self, bristle: AbstractBristle) -> Real:
        """The number as the bristle has it."""
        if isinstance(bristle, AngularSpring) and self.kind == "limit":
            return bristle.limit_angle
        assert self.leaf is not None
        leaf = jnp.asarray(jax.tree_util.tree_leaves(bristle)[self.leaf], dtype=float)
        return leaf if self.entry is None else leaf.ravel()[self.entry]

    def put(self, bristle: AbstractBristle, value: Real) -> AbstractBristle:
        """The bristle with another number; its constructor's checks do not run."""
        if isinstance(bristle, AngularSpring) and self.kind == "limit":
            height = bristle.length * jnp.cos(value)
            return eqx.tree_at(lambda b: b.height, bristle, height)
        leaves, structure = jax.tree_util.tree_flatten(bristle)
        assert self.leaf is not None
        if self.entry is not None:
            old = jnp.asarray(leaves[self.leaf], dtype=float)
            value = old.ravel().at[self.entry].set(value).reshape(old.shape)
        leaves[self.leaf] = value
        return jax.tree_util.tree_unflatten(structure, leaves)

    def _size(self, bristle: AbstractBristle) -> Real:
        size = jnp.abs(jax.lax.stop_gradient(self.now(bristle)))
        return jnp.where(size > 0, size, 1.0)

    def value(self, bristle: AbstractBristle, x: Real) -> Real:
        """The number that belongs to the coordinate `x`."""
        if self.kind == "positive":
            return self._size(bristle) * jnp.exp(x)
        if self.kind == "line":
            return self._size(bristle) * jnp.sinh(x)
        if isinstance(bristle, AngularSpring) and self.kind == "limit_by_height":
            return bristle.length * jnp.cos(x)
        if isinstance(bristle, AngularSpring) and self.kind == "limit_by_length":
            return bristle.height / jnp.cos(x)
        return x

    def coordinate(self, bristle: AbstractBristle, value: Real) -> Real:
        """`x` of a number, that of the nearest end where the number has none."""
        if self.kind == "positive":
            return jnp.log(jnp.maximum(value / self._size(bristle), SETTINGS.tiny))
        if self.kind == "line":
            return jnp.arcsinh(value / self._size(bristle))
        if isinstance(bristle, AngularSpring) and self.kind == "limit_by_height":
            return jnp.arccos(jnp.clip(value / bristle.length, 0.0, 1.0))
        if isinstance(bristle, AngularSpring) and self.kind == "limit_by_length":
            share = bristle.height / jnp.maximum(value, SETTINGS.tiny)
            return jnp.arccos(jnp.clip(share, 0, 1.0))
        return value

    def range(self) -> tuple[float, float]:
        """Ends of the coordinate where no bounds are given."""
        if self.kind in ("positive", "line"):
            scale = np.log if self.kind == "positive" else np.arcsinh
            most = float(scale(SETTINGS.decades))
            return -most, most
        return (-_RIGHT if self.kind == "angle" else 0.0), _RIGHT

    @property
    def own_range(self) -> tuple[float, float]:
        """Open interval in which constructors take the number."""
        if self.kind == "line":
            return -np.inf, np.inf
        if self.kind in ("angle", "limit"):
            return (-_RIGHT if self.kind == "angle" else 0.0), _RIGHT
        return 0.0, np.inf

    def range_of(self, bristle: AbstractBristle) -> tuple[float, float]:
        """`own_range`, with the length of a rod above its height."""
        low, high = self.own_range
        if isinstance(bristle, AngularSpring) and self.kind == "limit_by_height":
            return low, float(bristle.length)
        if isinstance(bristle, AngularSpring) and self.kind == "limit_by_length":
            return float(bristle.height), high
        return low, high

    def at(self, bristle: AbstractBristle, x: Real) -> AbstractBristle:
        """The bristle at the coordinate `x`."""
        return self.put(bristle, self.value(bristle, x))

    def interval(
        self, bristle: AbstractBristle, bounds: Float[Array, "2"]
    ) -> tuple[Real, Real]:
        """Ends of the coordinate under `bounds` (2,) of the number; NaN where none are."""
        low, high = self.range()
        ends = jax.vmap(lambda v: self.coordinate(bristle, v))(bounds)
        first, last = jnp.min(ends), jnp.max(ends)
        if self.kind not in ("positive", "line"):  # bounds of those may reach further
            first, last = jnp.maximum(first, low), jnp.minimum(last, high)
        free = jnp.any(jnp.isnan(bounds))
        return jnp.where(free, low, first), jnp.where(free, high, last)


def with_arrays(bristle: Any) -> Any:
    """A part whose plain floats are arrays too: numbers to choose and differentiate."""

    def array(leaf: Any) -> Any:
        return jnp.asarray(leaf) if isinstance(leaf, float | np.floating) else leaf

    return jax.tree_util.tree_map(array, bristle)


def free_parameter(
    bristle: Any, free: str, argument: str = "free", others: Sequence[str] = ()
) -> FreeParameter:
    """The number of a bristle called `free`.

    A field (`"height"`), a leaf further down (`"energy_fn.alpha"`, or its last name where
    no other leaf has it), or an entry of an array leaf (`"numbers[0]"`).

    Raises `ValueError` for a name that none or several have, with those there are and
    `others` that would do, naming the caller's `argument`.
    """
    if isinstance(bristle, AngularSpring) and free == "angle":
        return FreeParameter(free, "limit", None, None)
    named = _numbers_of(bristle)
    exact = [name for name in named if name == free]
    ends = [name for name in named if name.endswith(f".{free}")]
    found = exact or ends
    extra = ["angle"] if isinstance(bristle, AngularSpring) else []
    names = ", ".join([*named, *extra, *others])
    allowed = f"one of {names or 'no name: nothing to choose'}"
    require(len(found) == 1, argument, free, allowed)
    return FreeParameter(found[0], _kind_of(bristle, free), *named[found[0]])


def _kind_of(bristle: Any, free: str) -> str:
    """The coordinate in which a number is looked for; see `FreeParameter`."""
    if isinstance(bristle, AngularSpring) and free in _OF_RODS:
        return _OF_RODS[free]
    if free in getattr(bristle, "positive", ()):
        return "positive"
    return "angle" if free in getattr(bristle, "angles", ()) else "line"


def entries_of(part: Any, name: str) -> list[str]:
    """Names of the entries of an array leaf; none where it is one number, or unknown."""
    return [entry for entry in _numbers_of(part) if entry.startswith(f"{name}[")]


def _numbers_of(bristle: Any) -> dict[str, tuple[int, int | None]]:
    """Leaf and entry of every number of a bristle, by name."""
    found: dict[str, tuple[int, int | None]] = {}
    leaves = jax.tree_util.tree_flatten_with_path(bristle)[0]
    for index, (path, leaf) in enumerate(leaves):
        if not eqx.is_inexact_array(leaf):
            continue
        name = jax.tree_util.keystr(path, simple=True, separator=".")
        if np.ndim(leaf) == 0:
            found[name] = index, None
            continue
        for entry, place in enumerate(np.ndindex(np.shape(leaf))):
            found[f"{name}[{','.join(map(str, place))}]"] = index, entry
    return found


def require_bounds(
    free: FreeParameter, bristle: Any, bounds: Any, label: str = "bounds"
) -> None:
    """Check bounds of a free number: None, or (low, high) within its range."""
    if bounds is None or not is_known(bounds):
        return
    known = known_numbers(bounds)
    allowed = f"a pair (low, high) of finite numbers, low < high, of {free.name}"
    require(known.dtype != object and known.shape == (2,), label, bounds, allowed)
    good = bool(np.all(np.isfinite(known))) and known[0] < known[1]
    require(good, label, known, allowed)
    low, high = free.own_range
    if is_known(bristle):
        low, high = free.range_of(bristle)
    # By rounding alone: 1.5708 is beyond pi/2, and so is what a bristle would make of it.
    slack = SETTINGS.rounded * np.abs([low, high])
    inside = low - slack[0] <= known[0] and known[1] <= high + slack[1]
    nearly = np.allclose(np.clip(known, low, high), known, rtol=SETTINGS.alike, atol=0)
    ends = ", ".join(f"{end:.12g}" if nearly else as_text(end) for end in (low, high))
    needs = f"a part of ({ends}), where {free.name} can be"
    require(inside, label, known, needs)
