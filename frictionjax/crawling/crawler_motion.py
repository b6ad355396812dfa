"""What a crawler has done: its feet, its spring, how far it gets in a cycle."""

from typing import TYPE_CHECKING, Any

import equinox as eqx
import numpy as np
from jaxtyping import Float

from .._checks import CodedResult
from .._text import Named, SelfDrawn, ShownNumbers, dataset_over_time
from ..wiggly import Status

if TYPE_CHECKING:
    import xarray as xr

_COLUMNS = {
    "rear": ("m", "place of the rear foot"),
    "front": ("m", "place of the front foot"),
    "position": ("m", "middle of both feet"),
    "tension": ("N", "of the spring, which pulls the feet together"),
    "dissipation": ("J", "energy dissipated since t = 0"),
    "residual": ("J", "what is left of the energy balance"),
}


class CrawlerMotion(ShownNumbers, SelfDrawn, CodedResult, eqx.Module):
    """Motion of a crawler: `ts` in s, `rear` and `front` in m, shapes (n,).

    `tension` of the spring in N, positive where it pulls the feet together; `dissipation`
    since t = 0 in J, of both feet. `step`: how far the middle of the feet gets in the last
    cycle, in m, positive forwards; NaN where no cycle is known or it has not ended.
    `closed_form`: the step of a rigid-plastic foot in a cycle that grows and shrinks once,
    `(dl - 2 rho_f/k)` or 0, with the sign of the motion; NaN where there is no such cycle,
    as L does not come back or goes up and down more often, and where friction is the same
    both ways.

    At finite eps also `residual` in J, what is left of the energy balance, and `error`: how
    far in eps two runs at different tolerances are apart, at times outside slips; None of
    the limit. `status`, `ok`, `message`: a `Status`.
    """

    ts: Float[np.ndarray, " n"]
    rear: Float[np.ndarray, " n"]
    front: Float[np.ndarray, " n"]
    tension: Float[np.ndarray, " n"]
    dissipation: Float[np.ndarray, " n"]
    step: float
    closed_form: float
    code: int
    residual: Float[np.ndarray, " n"] | None = None
    error: float | None = None
    steps: int | None = None
    _outcomes = Status
    _picture = "draw_crawler"

    @property
    def position(self) -> Float[np.ndarray, " n"]:
        """The middle of both feet in m."""
        return (self.rear + self.front) / 2

    @property
    def _codes(self) -> Any:
        return np.asarray(self.code)

    def to_dataset(self) -> "xr.Dataset":
        """What there is over the dimension `time` (s), with units and how it ended.

        >>> breathing = fx.loads.Sine(amplitude=0.5, period=1.0)
        >>> found = fx.crawler(scene.profile, scene.bristle, 1.0, breathing, duration=3.0)
        >>> data = found.to_dataset()
        >>> print(f"{data.position[-1] - data.position[0]:.3f} {data.position.units}")
        -2.428 m
        """
        ended = {"status": self.status.name, "message": self.message}
        told = {"step": self.step, "closed_form": self.closed_form, "error": self.error}
        ended |= {name: value for name, value in told.items() if value is not None}
        return dataset_over_time(self, _COLUMNS, ended)

    def _in_words(self) -> str:
        by = "the limit" if self.steps is None else f"{self.steps} steps"
        step = f", {self.step:.6g} m a cycle" if np.isfinite(self.step) else ""
        return f"CrawlerMotion({self._ended}: {self.ts.size} times{step}, {by})"

    def _numbers(self) -> list[Named]:
        return [
            Named("step", self.step, "m", "of the last cycle, forwards positive"),
            Named("closed_form", self.closed_form, "m", "rigid-plastic, dl - 2 rho_f/k"),
            Named("position", self.position[-1], "m", "middle of the feet at the end"),
            Named("tension", self.tension[-1], "N", "of the spring at the end"),
            Named("dissipation", self.dissipation[-1], "J", "of both feet"),
            Named("error", self.error, "eps", "of places, by another run"),
            Named("steps", self.steps, "", "of all runs"),
        ]
