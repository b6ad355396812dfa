"""What the fit to a trace returns."""

import dataclasses
from typing import Any, NamedTuple

import numpy as np

from ..._text import Named, ShownNumbers, require_no_axes
from ...io import ARRAY, AS_IS, BOOLS, INTEGERS, NUMBER, Document, Form, by_name, record
from ...profiles import Fourier
from ..common import DesignResult
from ..measured_trace import Trace
from .status import TraceStatus
from .weights import TraceIdentifiability


class TraceHistory(NamedTuple):
    """Every iterate of a fit, arrays (steps,).

    `objective`: robust, with the prior, per sample. `chi2`: mean square of the residuals
    used, in standard deviations, infinite where none is. `used`, `slipping`, `disputed`:
    samples that count, are inside slips of the model, and are more than a quarter of a well
    off outside of them. `damping`: Marquardt's. `blur`: of the samples, in eps.
    """

    objective: np.ndarray
    chi2: np.ndarray
    used: np.ndarray
    slipping: np.ndarray
    disputed: np.ndarray
    damping: np.ndarray
    blur: np.ndarray


def _trace_entry(trace: Trace) -> dict[str, Any]:
    known = {"ts": trace.ts, trace.quantity: trace.values}
    given = trace.uncertainty is not None
    return known | ({"uncertainty": trace.uncertainty} if given else {})


_COUNTS = dict.fromkeys(("used", "slipping", "disputed"), INTEGERS)
_HISTORY = record(TraceHistory, TraceHistory._fields, ARRAY, **_COUNTS)
_FLAGS = dict.fromkeys(("determined", "visited"), BOOLS)
_SEEN = record(
    TraceIdentifiability, TraceIdentifiability._fields, ARRAY, rank=AS_IS, **_FLAGS
)


_BY_RESIDUALS = "1 at most by construction: no uncertainty was given"


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class TraceFit(ShownNumbers, DesignResult):
    """Result of `fit_trace`.

    `profile`: the surface found. `trace`: what was asked for, at `eps` and `gamma`.
    `achieved`: the same quantity of the surface found; `residuals`: achieved minus
    measured; `deviation`: standard deviation of a sample, with the accuracy of
    trajectories, or taken from the residuals where it was not known; N or m, (n,).
    `used`: samples that count; `slipping`: inside a slip of the model, left out;
    `disputed`: how many others are in another well. `tips`: phases of the tip, (n,).
    `chi2`: of samples used, in units of `deviation`, where they outnumber the coefficients,
    else of all outside slips, else of all; `degrees_of_freedom` of them, samples less
    coefficients, at least 1. Of a trace without uncertainties, which are taken from the
    residuals, they are equal by construction, or chi2 is less. `identifiability`: what the
    trace determines of the surface, seen by the bristle given.
    `odd`: what is odd about the trace, or was left undone, in words; empty where nothing.
    """

    profile: Fourier
    trace: Trace
    eps: float
    gamma: float
    achieved: np.ndarray
    residuals: np.ndarray
    deviation: np.ndarray
    used: np.ndarray
    slipping: np.ndarray
    disputed: int
    tips: np.ndarray
    chi2: float
    degrees_of_freedom: int
    status: TraceStatus
    history: TraceHistory
    identifiability: TraceIdentifiability
    odd: str = ""

    document = Document(
        "frictionjax.TraceFit",
        {"status": by_name(TraceStatus), "odd": AS_IS.or_else(lambda entries: "")}
        | dict.fromkeys(("eps", "gamma", "disputed"), NUMBER)
        | dict.fromkeys(("chi2", "degrees_of_freedom"), NUMBER)
        | dict.fromkeys(("achieved", "residuals", "deviation", "tips"), ARRAY)
        | {
            "used": BOOLS,
            "slipping": BOOLS,
            "profile": record(Fourier, ("cos", "sin"), ARRAY),
            "trace": Form(_trace_entry, lambda entry: Trace(**entry)),
            "history": _HISTORY,
            "identifiability": _SEEN,
        },
    )

    @property
    def message(self) -> str:
        """Why, for people, and what is determined."""
        seen = self.identifiability
        why = f"{self.status.message}: {self.odd}" if self.odd else self.status.message
        if not seen.determined.any():
            return f"{why}; no slope is determined"
        parts = ", ".join(f"[{a:.3f}, {b:.3f}]" for a, b in seen.intervals)
        return (
            f"{why}; slopes determined at y in {parts} ({seen.share:.0%}), for the bristle "
            "given: it is taken as known, and another one would see other slopes"
        )

    @property
    def reduced_chi2(self) -> float:
        """`chi2` per degree of freedom."""
        return self.chi2 / self.degrees_of_freedom

    @property
    def covariance(self) -> np.ndarray:
        """Of cos and sin, without a prior; see `identifiability`."""
        return self.identifiability.covariance

    @property
    def singular_values(self) -> np.ndarray:
        """Of the derivatives of the samples used; see `identifiability`."""
        return self.identifiability.singular_values

    def plot(self, truth: Any = None, ax: Any = None, figure: Any = None) -> Any:
        """Data, fit, residuals and slopes with their errors, as a Figure.

        `truth`: a profile to draw beside the one found. `figure`: a matplotlib Figure or
        SubFigure to draw into; `ax` is refused, as the picture has several axes.

        >>> trace = fx.simulate_trace(scene, eps=0.1, noise=0.001)
        >>> fit = fx.fit_trace(trace, scene, eps=0.1, harmonics=2, progress=False)
        >>> [axes.get_xlabel() for axes in fit.plot(truth=scene.profile).axes]
        ['t (s)', 'phase y (periods)', 't (s)', 'phase y (periods)']
        """
        require_no_axes(ax)
        from ...plot import draw_trace_fit

        return draw_trace_fit(self, truth, figure)

    def _numbers(self) -> list[Named]:
        return [
            Named("eps", self.eps, "m", "period of the wiggles"),
            Named("samples", self.used.size),
            Named("used", int(np.sum(self.used)), "", "of them"),
            Named("slipping", int(np.sum(self.slipping)), "", "in slips, left out"),
            Named("disputed", self.disputed, "", "in other wells"),
            Named("reduced_chi2", self.reduced_chi2, "", self._about_chi2()),
            Named("determined", self.identifiability.share, "", "share of the surface"),
            Named("steps", self.history.chi2.size, "", "of the fit"),
        ]

    def _about_chi2(self) -> str:
        if self._by_residuals:
            return _BY_RESIDUALS
        return "about 1 where errors explain it"

    @property
    def _by_residuals(self) -> bool:
        """Whether a fit has taken uncertainties from what it leaves."""
        return self.trace.uncertainty is None and self.history.chi2.size > 0

    def __repr__(self) -> str:
        told = f" ({_BY_RESIDUALS})" if self._by_residuals else ""
        used = f"{int(np.sum(self.used))} of {self.used.size} samples used"
        left = f"{int(np.sum(self.slipping))} in slips, {self.disputed} in other wells"
        return "\n".join(
            [
                f"TraceFit({self.status.name}: {self.message})",
                f"  {used}, {left}; reduced chi2 = {self.reduced_chi2:.4g}{told}, "
                f"{self.history.chi2.size} steps",
            ]
        )
