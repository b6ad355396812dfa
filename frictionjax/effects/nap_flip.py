"""A rod that turns over where it is moved against its nap."""

from collections.abc import Sequence
from typing import ClassVar

import equinox as eqx

from .._checks import Asked, Real, as_real, require_real
from .abstract import AbstractEffect, Stage


class NapFlip(AbstractEffect):
    """The energetic effect of Section 3.4: a rod on an angular spring that turns over.

    `bending_stiffness` B in N m^2. Where the compression of the rod comes to the load that
    buckles it between hinges, `pi^2 B/L^2`, while its root moves against its nap, its tip
    stays where it is until the root has gone past it; then it stands the other way, its
    spring's rest angle on the other side. In between it is an elastica. `z = u + c` is the
    state of the root in both modes; `root` u, and `mode`: 1 as it stands at first, -1
    turned over, 0 in between. In a slip with the nap the compression of a straight rod
    passes the critical load for a moment, which turns nothing: its root moves with the nap.

    Such a load has to be one of those that `fx.nap` calls the window: above the
    compressions of slides with the nap of both modes, below those against it.

    Raises `ValueError` for a bending stiffness that is not positive and finite.

    >>> rough, load = fx.profiles.Sine(slope=0.5), fx.loads.Triangle(2.5, period=3.0)
    >>> rod = fx.bristles.AngularSpring(1.0, length=1.4, height=1.0, rest_angle=0.3)
    >>> flips = (fx.effects.NapFlip(bending_stiffness=0.1),)
    >>> turning = scene.replace(profile=rough, bristle=rod, load=load, effects=flips)
    >>> print(fx.solve_limit(turning, ts=[0.0, 0.75, 1.5, 2.25, 3.0]).mode)
    [ 1  1 -1 -1  1]
    """

    asked: ClassVar = {"bending_stiffness": Asked("N m^2", "> 0, in the window of nap")}

    stage: ClassVar[Stage] = Stage.STATE
    of_bristle: ClassVar[str] = "AngularSpring"

    bending_stiffness: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        name = "effects.NapFlip.bending_stiffness"
        allowed = "bending_stiffness > 0 in N m^2"
        require_real(name, self.bending_stiffness, allowed, lambda B: B > 0)


def nap_flip_among(effects: Sequence[AbstractEffect]) -> NapFlip | None:
    """The turning over among effects of a scene, which has one at most."""
    return next((effect for effect in effects if isinstance(effect, NapFlip)), None)
