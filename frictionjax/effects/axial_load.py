"""Compression of a rod, held against the load at which it buckles."""

from typing import ClassVar

import equinox as eqx

from .._checks import Asked, Real, as_real, require_real
from .abstract import AbstractEffect, Stage


class AxialLoad(AbstractEffect):
    """Asks how near a rod on an angular spring comes to buckling; changes no motion.

    `bending_stiffness` B in N m^2, of the rod. The rod is held by its angular spring at
    the root and hinged at the tip. Below the critical load of that column it is "not shown
    to buckle", which is not "stable": bristles that are sheared at the tip can buckle below
    it (J. R. Soc. Interface 7, 1581, 2010). `mechanics` tells the compression along a
    solution, `sweep` and `study` the largest of every cell. Beside `NapFlip`, whose rod
    gives way as one between two hinges and has the same B, they tell what that leaves: how
    near its straight modes come to the load of the rod on its spring.

    Raises `ValueError` for a bending stiffness that is not positive and finite.

    >>> rod = fx.bristles.AngularSpring(1.0, length=1.4, height=1.0, rest_angle=0.3)
    >>> asked = (fx.effects.AxialLoad(bending_stiffness=0.1),)
    >>> held = scene.replace(bristle=rod, effects=asked)
    >>> fx.mechanics(held, fx.solve_limit(held)).buckling
    'below the critical load everywhere: not shown to buckle'
    """

    asked: ClassVar = {"bending_stiffness": Asked("N m^2", "> 0")}

    stage: ClassVar[Stage] = Stage.READING
    of_bristle: ClassVar[str] = "AngularSpring"

    bending_stiffness: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        name = "effects.AxialLoad.bending_stiffness"
        allowed = "bending_stiffness > 0 in N m^2"
        require_real(name, self.bending_stiffness, allowed, lambda B: B > 0)
