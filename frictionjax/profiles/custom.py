"""Profile given as a function."""

from collections.abc import Callable

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from .._checks import Real, as_plain, require_function, require_whole
from .profile import AbstractProfile, require_smooth


class Custom(AbstractProfile):
    """The profile `w(y) = fn(y)` for 0 <= y < 1, continued with period 1.

    `fn`: scalar to scalar, written with `jax.numpy`; an `equinox.Module` with leaves is
    traced like any other part. `points` samples a period must resolve `fn'`. A function is
    read once: other numbers need another one, or leaves of a module.

    Raises `ValueError` naming the derivative that jumps where `fn` does not repeat as a
    C^2 function (at the seam or inside), or `fn` is constant or not finite.

    >>> import jax.numpy as jnp
    >>> surface = fx.profiles.Custom(lambda y: 0.02 * jnp.exp(jnp.cos(2 * jnp.pi * y)))
    >>> print(surface(np.array([0.0, 0.25, 0.5])).round(4))
    [0.0544 0.02   0.0074]
    """

    fn: Callable[[Real], Real]
    points: int = eqx.field(static=True, default=4096, converter=as_plain)

    def __check_init__(self):
        require_function("profile.fn", self.fn, "a function of y")
        require_whole("profile.points", self.points, 16)
        require_smooth("profile.fn", self.fn, self.points)

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return self.fn(jnp.asarray(y) - jnp.floor(y))
