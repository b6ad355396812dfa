"""Linear horizontal spring."""

from typing import ClassVar, cast

import equinox as eqx
from jaxtyping import Array, ArrayLike, Float

from .._checks import Asked, Real, as_real, require_real
from .support import AbstractSupport


class Spring(AbstractSupport):
    """`Phi(z) = stiffness/2 z^2`; `stiffness` k_h in N/m.

    Raises `ValueError` for a stiffness that is not positive.

    >>> soft = scene.replace(support=fx.supports.Spring(stiffness=0.5))
    >>> print(fx.solve_limit(soft, ts=[0.75]).z.round(4))
    [1.8592]
    """

    asked: ClassVar = {"stiffness": Asked("N/m", "> 0")}

    stiffness: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        require_real("support.stiffness", self.stiffness, "stiffness > 0", lambda k: k > 0)

    def energy(self, z: Real) -> Real:
        return 0.5 * self.stiffness * z**2

    def state_of(self, force: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return cast(Array, force / self.stiffness)

    def state_near(self, force: Real, guess: Real) -> Real:
        return self.state_of(force)
