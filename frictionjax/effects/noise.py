"""Thermal noise."""

from collections.abc import Sequence
from typing import Any, ClassVar

import equinox as eqx

from .._checks import Asked, Real, as_real, require_real
from .abstract import AbstractEffect, Stage


class Noise(AbstractEffect):
    """Thermal noise of an overdamped tip, of the energy `T_eps = temperature eps^exponent`:

    `eps^gamma dz = (l - Phi'(z) - V_eps'(z)) dt + sqrt(2 eps^gamma T_eps) dB`.

    `temperature` in J per m^exponent, Boltzmann's constant included; `exponent`: a number.
    Wells are of the order of eps rho deep, so the exponent 1 keeps barrier over temperature
    as eps falls. What noise takes of the friction still grows then, like a logarithm, as
    slips have ever more time to come early: it vanishes above 1 (faster than
    eps/log(1/eps), to be exact), and takes over at 1 and below (`benchmarks/noise.py`).

    Raises `ValueError` for a temperature that is not positive and finite (without noise a
    scene has no such effect), or an exponent that is not finite.

    >>> warm = fx.effects.Noise(temperature=1e-3)
    >>> print(f"{warm.temperature_at(0.01):.0e} J")
    1e-05 J
    """

    asked: ClassVar = {
        "temperature": Asked("J per m^exponent", "> 0"),
        "exponent": Asked("no unit", "any"),
    }

    stage: ClassVar[Stage] = Stage.STATE

    temperature: Real = eqx.field(converter=as_real)
    exponent: Real = eqx.field(converter=as_real, default=1.0)

    def __check_init__(self):
        allowed = "temperature > 0 in J; leave the effect out for none"
        require_real(
            "effects.Noise.temperature", self.temperature, allowed, lambda T: T > 0
        )
        require_real("effects.Noise.exponent", self.exponent, "any exponent of eps")

    def temperature_at(self, eps: Any) -> Any:
        """`T_eps` in J; eps in m, any shape."""
        return self.temperature * eps**self.exponent


def noise_among(effects: Sequence[AbstractEffect]) -> Noise | None:
    """The noise among effects of a scene, which has one at most."""
    return next((effect for effect in effects if isinstance(effect, Noise)), None)
