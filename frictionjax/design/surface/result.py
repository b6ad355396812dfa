"""What the fit of a profile returns."""

import dataclasses
from collections.abc import Callable
from functools import cached_property
from typing import Any

import jax
import numpy as np

from ..._checks import as_text, require_real, require_whole
from ...bristles import AbstractBristle, pulling_text
from ...io import written
from ...model import Coefficients
from ...profiles import Fourier
from .barrier import heights_of_waves, waves_of_heights
from .history import History, Start
from .json import profile_from_json, profile_to_json
from .open_directions import CoefficientIdentifiability, members
from .status import ProfileStatus


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class ProfileFit:
    """Result of `fit_profile`.

    `profile`, `bristles`: the best surface and the bristles on it, one for each target.
    `coefficients`: of each target, as `friction` recomputes them. `targets`: (targets, 2)
    in N. `bending_energy`: `int_0^1 w''^2`; `bending_bound`: proven lower bound of it for
    surfaces with these extreme slopes as far apart as here (0 where nothing is proven).
    `residuals`: achieved minus target in N; `largest_error`: the largest of them, relative.
    `chi2`: weighted squares, in units of uncertainties where given, else of the targets;
    `degrees_of_freedom` of them, and `misfit` = sqrt(chi2/residuals). `starts`: best first.
    `free`: value of each free parameter by name. `bounds`: those on the surface.
    `identify`: makes `identifiability`, when that is asked for.
    """

    profile: Fourier
    bristles: tuple[AbstractBristle | None, ...]
    coefficients: tuple[Coefficients, ...]
    targets: np.ndarray
    bending_energy: float
    bending_bound: float
    residuals: np.ndarray
    largest_error: float
    chi2: float
    degrees_of_freedom: int
    misfit: float
    success: bool
    status: ProfileStatus
    message: str
    starts: tuple[Start, ...]
    history: History | None
    identify: Callable[[], CoefficientIdentifiability]
    free: dict[str, float]
    bounds: dict[str, float | None]

    @cached_property
    def identifiability(self) -> CoefficientIdentifiability:
        """What the coefficients see of the surface, and what they leave open."""
        return self.identify()

    @property
    def singular_values(self) -> np.ndarray:
        """Of the sensitivities of the coefficients; see `identifiability`."""
        return self.identifiability.singular_values

    @property
    def rank(self) -> int:
        """How many directions the coefficients see."""
        return self.identifiability.rank

    @property
    def open_directions(self) -> np.ndarray:
        """Directions that they do not see; see `identifiability`."""
        return self.identifiability.open_directions

    def family(self, count: int = 16, size: float = 0.5, seed: int = 0) -> list[Fourier]:
        """Other surfaces with exactly the same coefficients, within the same bounds.

        `size`: how far, as the square root of the bending energy of what is added over
        that of the profile, before the extreme slopes are set again. Fewer than `count`
        where the bounds leave no room.

        Raises `ValueError` for a count or a size that is not positive.
        """
        require_whole("count", count)
        require_whole("seed", seed, 0)
        require_real("size", size, "a number > 0", lambda v: v > 0)
        sharp, high = (self.bounds[k] for k in ("smallest_radius", "largest_amplitude"))
        known: Any = (
            waves_of_heights(self.profile.cos, self.profile.sin),
            jax.random.split(jax.random.PRNGKey(seed), count),
            float(size),
            np.inf if sharp is None else 1 / sharp,
            np.inf if high is None else float(high),
        )
        waves, good = members(*known)
        cos, sin = (np.asarray(rows) for rows in heights_of_waves(waves))
        return [Fourier(cos[i], sin[i]) for i in np.flatnonzero(np.asarray(good))]

    def plot(self):
        """The surface, what is left open, the starts and the targets, as a Figure."""
        from ...plot import draw_profile_fit

        return draw_profile_fit(self)

    def to_json(self, path: Any = None) -> str:
        """Everything but the iterates' shapes as JSON; written to `path` where given."""
        return written(profile_to_json(self), path)

    @classmethod
    def from_json(cls, source: Any) -> "ProfileFit":
        """The result again, from the text or the path of its JSON.

        Bristles given as functions are None, the iterates' shapes empty. Raises
        `ValueError` for what is no such JSON.
        """
        return cls(**profile_from_json(source))

    def __repr__(self) -> str:
        rows = [
            f"ProfileFit({self.status.name}: {self.message})",
            f"  bending_energy = {as_text(self.bending_energy)}, "
            f"largest_error = {self.largest_error:.3g}, rank = {self.rank}",
        ]
        for wanted, found in zip(self.targets, self.coefficients, strict=True):
            rows.append(
                f"  rho_plus = {as_text(found.rho_plus)} N (target {as_text(wanted[0])}), "
                f"rho_minus = {as_text(found.rho_minus)} N (target {as_text(wanted[1])})"
            )
        rows += [f"  {name} = {as_text(value)}" for name, value in self.free.items()]
        both = zip(self.coefficients, self.bristles, strict=True)
        pulls = [pulling_text(found.alpha, part) for found, part in both]
        rows += [f"  {text}" for text in dict.fromkeys(pulls) if text]
        return "\n".join(rows)
