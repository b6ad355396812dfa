"""Mass of what moves."""

from collections.abc import Sequence
from typing import Any, ClassVar

import equinox as eqx

from .._checks import Asked, Real, as_real, require_real
from .abstract import AbstractEffect, Stage


class Inertia(AbstractEffect):
    """What moves has the mass `m_eps = mass eps^exponent`, and starts at rest at z0:

    `m_eps z'' + eps^gamma z' = l - Phi'(z) - V_eps'(z)`.

    `mass` in kg per m^exponent; `exponent`: a number. What decides is
    `beta = m_eps max|W''| eps^(-1 - 2 gamma)`, the square of the time in which speeds are
    forgotten over that of an oscillation in a well: far below 1 the system is the
    overdamped one, above it tips run through several wells in a slip. A mass that does not
    fall faster than `eps^(1 + 2 gamma)` is not overdamped in the limit, which then is not
    the paper's.

    Raises `ValueError` for a mass that is not positive and finite (without mass a scene
    has no such effect), or an exponent that is not finite.

    >>> heavy = scene.replace(effects=(fx.effects.Inertia(mass=1e-3, exponent=1.0),))
    >>> fx.explain(heavy, eps=0.01, gamma=1.0).effects.source.sel(effect="Inertia").item()
    'beta = 7.1: overdamped far below 1'
    """

    asked: ClassVar = {
        "mass": Asked("kg per m^exponent", "> 0"),
        "exponent": Asked("no unit", "any"),
    }

    stage: ClassVar[Stage] = Stage.STATE

    mass: Real = eqx.field(converter=as_real)
    exponent: Real = eqx.field(converter=as_real, default=0.0)

    def __check_init__(self):
        allowed = "mass > 0 in kg; leave the effect out for none"
        require_real("effects.Inertia.mass", self.mass, allowed, lambda m: m > 0)
        require_real("effects.Inertia.exponent", self.exponent, "any exponent of eps")

    def mass_at(self, eps: Any) -> Any:
        """`m_eps` in kg; eps in m, any shape."""
        return self.mass * eps**self.exponent


def inertia_among(effects: Sequence[AbstractEffect]) -> Inertia | None:
    """The inertia among effects of a scene, which has one at most."""
    return next((effect for effect in effects if isinstance(effect, Inertia)), None)
