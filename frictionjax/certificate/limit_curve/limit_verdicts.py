"""What the certificate of a limit curve says, and why."""

from typing import NamedTuple

from ..._checks import Outcome, Result, as_text
from ..._text import Named, SelfDrawn, ShownNumbers


class LimitCertificateStatus(Outcome):
    """Why a curve is or is not accepted; `message` says it for people."""

    OK = 0, "the curve solves the limit system"
    NOT_FINITE = 1, "the curve holds values that are not finite"
    OUTSIDE = 2, "the curve leaves the strip: forces are beyond friction"
    OFF = 3, "the curve moves where friction holds it, or comes too late or too far"


class _Numbers(NamedTuple):
    residual: float
    scale: float
    distance: float
    excess: float
    tolerance: float
    status: LimitCertificateStatus


class LimitCertificate(ShownNumbers, SelfDrawn, Result, _Numbers):
    """What was found about a curve of the limit system.

    `residual` in J: what the balance `E(t2) - E(t1) + int l' z + int R(z')` is off by at
    least, however the curve moves between its samples. `scale` in J: the energy of a way
    through the strip and back, `rho_plus - rho_minus` times its width. `distance` from the
    nearest solution, whatever its start, at the samples, and `tolerance`, what of it is
    accepted: both over the width of the strip, the least on the way. `excess`: the most by
    which a force `l - Phi'(z)` leaves [rho_minus, rho_plus], over the length of that.
    `status`: a `LimitCertificateStatus`; `ok`, `message`: the verdict.
    """

    __slots__ = ()
    _picture = "draw_certificate"

    @property
    def shares(self) -> dict[str, float]:
        """What decides, over the most of each that is accepted: above 1 is refused."""
        return {
            "excess": self.excess / self.tolerance,
            "distance": self.distance / self.tolerance,
        }

    def __repr__(self) -> str:
        numbers = zip(self._fields[:-1], self[:-1], strict=True)
        told = ", ".join(f"{name}={as_text(value)}" for name, value in numbers)
        return f"LimitCertificate({told}, status={self.status.name}: {self.message})"

    def _numbers(self) -> list[Named]:
        return [
            Named("distance", self.distance, "", "from solutions, over the strip's width"),
            Named("excess", self.excess, "", "force beyond friction, over its interval"),
            Named("tolerance", self.tolerance, "", "of both, accepted"),
            Named("residual", self.residual, "J", "of the energy balance, at least"),
            Named("scale", self.scale, "J", "a way through the strip and back"),
        ]
