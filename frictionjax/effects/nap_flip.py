"""A rod that buckles against the nap and turns over: the paper's energetic effect."""

import equinox as eqx

from .._checks import Real, as_real, require_real
from .abstract import AbstractEffect


class NapFlip(AbstractEffect):
    """A rod on an angular spring that turns over where it is moved against the nap.

    `bending_stiffness` B in N m^2, of the rod. Where its compression reaches pi^2 B/L^2,
    the critical load between hinged ends, the rod buckles, its tip stays where it is, and
    its root goes past it; then the rod is straight again, behind its root, its rest angle
    of the other sign (Section 3.4).

    Raises `ValueError` for a bending stiffness that is not positive and finite.
    """

    bending_stiffness: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        name, allowed = "effects.NapFlip.bending_stiffness", "bending_stiffness > 0"
        require_real(name, self.bending_stiffness, allowed, lambda B: B > 0)
