"""Load given by the end of the horizontal spring, as a place."""

from typing import Any, ClassVar

import equinox as eqx
from jaxtyping import Array, Float

from .._checks import Asked, Real, as_real, exchanged, require, require_real
from .completeness import turning_points_of
from .load import AbstractLoad


class Pulled(AbstractLoad):
    """`l(t) = k_h (q(t) - L_h + c)`: the far end of the horizontal spring is at q(t).

    `position`: a load read as q(t) in m. `rest_length` L_h in m. The stiffness k_h of the
    spring and the constant c of the state `z = u + c` (u the root) are the scene's: it
    fills in `stiffness` and `constant` when it is built, again whenever parts of it are
    exchanged, and derivatives by its support and its bristle go through them. (The paper
    prints `l = k_h (q - L_h)`: without c the rest `k_h (q - L_h - u)` would not be
    `l - k_h z`.)

    Raises `ValueError` for a position that is no load or a rest length that is not finite;
    a scene for a support that is no `Spring`; and where l is asked for before there is a
    scene.

    >>> moved = fx.loads.PiecewiseLinear(times=[0.0, 3.0], values=[2.0, 3.0])
    >>> dragged = scene.replace(load=fx.loads.Pulled(moved, rest_length=0.44))
    >>> print(f"{dragged.load(0.0):.4f} N, {dragged.load(3.0):.4f} N")
    0.0026 N, 1.0026 N
    """

    asked: ClassVar = {
        "position": Asked("m", "a table [load.position]: a load read as m"),
        "rest_length": Asked("m", "any"),
    }

    position: AbstractLoad
    rest_length: Real = eqx.field(converter=as_real)
    stiffness: Real | None = eqx.field(init=False)
    constant: Real | None = eqx.field(init=False)

    def __init__(self, position: AbstractLoad, rest_length: Any = 0.0):
        self.position, self.rest_length = position, rest_length
        self.stiffness = self.constant = None

    def __check_init__(self):
        known = isinstance(self.position, AbstractLoad)
        known = known and not isinstance(self.position, Pulled)
        needs = "another part of frictionjax.loads, read as q(t) in m"
        require(known, "load.position", type(self.position).__name__, needs)
        require_real("load.rest_length", self.rest_length, "any length in m")

    def held_by(self, stiffness: Real, constant: Real) -> "Pulled":
        """The load with the spring of a scene, k_h in N/m and c in m."""
        return exchanged(self, {"stiffness": stiffness, "constant": constant})

    def __call__(self, t: Real) -> Real:
        return self.of_place(self.position(t))

    def of_place(self, q: Real) -> Real:
        """l in N where the spring's end is at q (m)."""
        needs = "a Scene, whose spring it is part of: ask scene.load"
        require(self.stiffness is not None, "load", "Pulled", needs)
        assert self.stiffness is not None
        assert self.constant is not None
        return self.stiffness * (q + (self.constant - self.rest_length))

    @property
    def steepest(self) -> Real | None:
        """When a position given as a function moves fastest, where that is known."""
        return getattr(self.position, "steepest", None)

    def turning_count(self, duration: float) -> int:
        return self.position.turning_count(duration)

    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        return turning_points_of(self.position, duration, count)

    def prepared(self, duration: Real) -> "Pulled":
        return exchanged(self, {"position": self.position.prepared(duration)})
