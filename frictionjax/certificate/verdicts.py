"""What a certificate says, and why."""

import math
from typing import NamedTuple

from .._checks import Outcome, Result, as_text
from .._text import Named, SelfDrawn, ShownNumbers
from .settings import SETTINGS


class CertificateStatus(Outcome):
    """Why a curve is or is not accepted; `message` says it for people."""

    OK = 0, "the curve solves the wiggly system"
    NOT_FINITE = 1, "the curve holds values that are not finite"
    UNRESOLVED = (
        2,
        "samples are more than eps/4 apart, or too few to tell the viscosity of slips, or "
        "far apart where a rod turns over, or steps between them do not agree: undecided",
    )
    SKIPPED = 3, "a well was crossed without the force that this takes"
    OFF = 4, "the curve is too far from every solution"
    VISCOSITY = 5, "slips take another time than eps^gamma gives them"
    VELOCITY = 6, "the velocity is not that of the curve"
    TURN = 7, "the rod turns over at another load than the critical one, or not at it"


class _Numbers(NamedTuple):
    residual: float
    residual_error: float
    scale: float
    slips: int
    skipped: int
    distance: float
    within: float
    missing_force: float
    viscosity: float
    spacing: float
    status: CertificateStatus


class Certificate(ShownNumbers, SelfDrawn, Result, _Numbers):
    """What was found about a curve.

    `residual` of the energy-dissipation balance in J, `int (eps^gamma z' + D E)^2 /
    (2 eps^gamma)`, with its quadrature error `residual_error`; `scale = eps (rho_plus -
    rho_minus)`, the energy of one slip, in J. `slips`: wells crossed. `distance`: the
    curve is at least so far, in units of eps, from every solution; `within`: at most so far
    from one, inf where that cannot be said. `missing_force`: the most that was missing when
    a well was left, in units of `Phi'' eps`, the force of one well. `viscosity`: measured
    in slips, relative to `eps^gamma`; NaN without slips that tell it. `skipped`: wells
    crossed without the force. `status`: a `CertificateStatus`; `ok`: whether the curve is
    within about eps/100 of a solution; `message`: the verdict. What some of these are for
    arrays, tips with mass and rods that turn over, `certify` tells.
    """

    __slots__ = ()
    _picture = "draw_certificate"

    @property
    def message(self) -> str:
        """The verdict; of samples that leave it open what is the matter, where known."""
        if self.status != CertificateStatus.UNRESOLVED:
            return super().message
        if self.spacing > SETTINGS.coarsest:
            most = f"eps/{1 / SETTINGS.coarsest:g}"
            spacing = as_text(self.spacing)
            return f"samples are {spacing} eps apart, more than {most}: undecided"
        seen = abs(self.viscosity - 1) > SETTINGS.viscosity
        if seen and not math.isnan(self.missing_force):  # no tip with mass
            return "samples are too few to tell the viscosity of slips: undecided"
        return super().message

    @property
    def shares(self) -> dict[str, float]:
        """Numbers that decide, over the most of each that is accepted: above 1 is refused.

        Forces decide where `within` does not; `viscosity` by its distance from 1, and where
        `within` decides only if samples are close enough to tell it. NaN: of a curve that
        has none, without slips. What else decides of tips with mass, rods that turn over
        and curves that are `OFF` closer by, `status` tells.
        """
        apart = {"spacing": self.spacing / SETTINGS.coarsest}
        near = {"distance": self.distance / SETTINGS.farthest}
        force = {"missing_force": self.missing_force / SETTINGS.missing_force}
        viscosity = {"viscosity": abs(self.viscosity - 1) / SETTINGS.viscosity}
        if self.within > SETTINGS.surely:
            return {**apart, **force, **viscosity, **near}
        seen = self.status == CertificateStatus.VISCOSITY
        return {**apart, **(viscosity if seen else {}), **near}

    def __repr__(self) -> str:
        numbers = zip(self._fields[:-1], self[:-1], strict=True)
        told = ", ".join(f"{name}={as_text(value)}" for name, value in numbers)
        return f"Certificate({told}, status={self.status.name}: {self.message})"

    def _numbers(self) -> list[Named]:
        return [
            Named("distance", self.distance, "eps", "at least, from every solution"),
            Named("within", self.within, "eps", "at most, from a solution"),
            Named("residual", self.residual, "J", "of the energy-dissipation balance"),
            Named("residual_error", self.residual_error, "J", "of its quadrature"),
            Named("scale", self.scale, "J", "energy of one slip"),
            Named("slips", self.slips, "", "wells crossed"),
            Named("skipped", self.skipped, "", "wells crossed without the force"),
            Named("missing_force", self.missing_force, "", "most, over that of one well"),
            Named("viscosity", self.viscosity, "", "seen in slips, over eps^gamma"),
            Named("spacing", self.spacing, "eps", "of samples, at most"),
        ]


def nothing_known(scale: float) -> Certificate:
    """Of a curve with values that are not finite."""
    unknown = math.nan
    return Certificate(
        residual=unknown,
        residual_error=unknown,
        scale=scale,
        slips=0,
        skipped=0,
        distance=unknown,
        within=unknown,
        missing_force=unknown,
        viscosity=unknown,
        spacing=unknown,
        status=CertificateStatus.NOT_FINITE,
    )
