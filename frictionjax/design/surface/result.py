"""What the fit of a profile returns."""

import dataclasses
from collections.abc import Callable
from functools import cached_property, partial
from typing import Any

import jax
import numpy as np

from ..._checks import as_text, require_real, require_whole
from ..._text import Named, ShownNumbers, require_no_axes
from ...bristles import AbstractBristle, pulling_text
from ...coefficients import Coefficients
from ...contact import Nap, nap
from ...effects import AbstractEffect, Engine, nap_flip_among
from ...io import ARRAY, AS_IS, NUMBER, PART, TOLD, Document, Form, by_name, record, several
from ...profiles import Fourier
from ..common import EFFECT_FORM, DesignResult, effects_of_scene, named_forces
from .barrier import heights_of_waves, waves_of_heights
from .history import History, Start
from .open_directions import CoefficientIdentifiability, members
from .seen_family import surfaces_seen_alike
from .status import MET, ProfileStatus

_SHAPES = ("cos", "sin", "free")  # of iterates: most of the numbers, left out


def _without_shapes(**columns: Any) -> History:
    empty = np.zeros((*columns["loss"].shape, 0))
    return History(**columns, **dict.fromkeys(_SHAPES, empty))


def _as_found(**seen: Any) -> Callable[[], CoefficientIdentifiability]:
    """What `identify` is of a fit that has been asked before."""
    return partial(CoefficientIdentifiability, **seen)


_COEFFICIENTS = record(
    Coefficients,
    [field.name for field in dataclasses.fields(Coefficients)],
    NUMBER._replace(write=float),
)
_START = record(
    Start,
    Start._fields,
    NUMBER,
    status=by_name(ProfileStatus),
    free=Form(read=tuple),
)
_HISTORY = record(
    _without_shapes, [name for name in History._fields if name not in _SHAPES], ARRAY
)
_SEEN = record(
    _as_found,
    CoefficientIdentifiability._fields,
    ARRAY,
    rank=AS_IS,
)


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class ProfileFit(ShownNumbers, DesignResult):
    """Result of `fit_profile`.

    `profile`, `bristles`: the best surface and the bristles on it, one for each target.
    `coefficients`: of each target, as `friction` recomputes them (of the scene with its
    `effects`, those of a compliant array of all its bristles). `targets`: (targets, 2)
    in N. `bending_energy`: `int_0^1 w''^2`; `bending_bound`: proven lower bound of it for
    surfaces with these extreme slopes, all of them; with bounds on the surface, with free
    bristles and for targets that differ, those with them as far apart as here (0 where
    nothing is proven).
    `residuals`: achieved minus target in N; `largest_error`: the largest of them, relative.
    `chi2`: weighted squares, in units of uncertainties where given, else of the targets;
    `degrees_of_freedom` of them, and `misfit` = sqrt(chi2/residuals). `starts`: best first.
    `free`: value of each free parameter by name. `bounds`: those on the surface.
    `identify`: makes `identifiability`, when that is asked for. `why`: the `message`.
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
    status: ProfileStatus
    why: str
    starts: tuple[Start, ...]
    history: History | None
    identify: Callable[[], CoefficientIdentifiability]
    free: dict[str, float]
    bounds: dict[str, float | None]
    effects: tuple[AbstractEffect, ...] = ()

    _good = MET
    document = Document(
        "frictionjax.ProfileFit",
        {"status": by_name(ProfileStatus)}
        | dict.fromkeys(("bending_energy", "bending_bound", "largest_error"), NUMBER)
        | dict.fromkeys(("chi2", "degrees_of_freedom", "misfit"), NUMBER)
        | {
            "success": TOLD,
            "message": AS_IS._replace(argument="why"),
            "free": AS_IS,
            "bounds": AS_IS,
            "profile": record(Fourier, ("cos", "sin"), ARRAY),
            "bristles": several(PART),
            "coefficients": several(_COEFFICIENTS),
            "targets": ARRAY,
            "effects": EFFECT_FORM,
            "residuals": ARRAY,
            "starts": several(_START),
            "history": _HISTORY.or_else(lambda entries: None),
            "identifiability": _SEEN._replace(argument="identify"),
        },
        infinite=False,
    )

    @property
    def message(self) -> str:
        """Why, for people."""
        return self.why

    @cached_property
    def identifiability(self) -> CoefficientIdentifiability:
        """What the coefficients see of the surface, and what they leave open."""
        return self.identify()

    @property
    def naps(self) -> tuple[Nap, ...]:
        """Of each target, what `nap` says of its bristle on the surface.

        With `effects.NapFlip` of a rod of that bending stiffness: whether it turns over, so
        that friction is `rho_with` one way and `rho_flipped` the other, and the `window` of
        critical loads for which one does.
        """
        flip = nap_flip_among(self.effects)
        stiff = None if flip is None else flip.bending_stiffness
        known = [bristle for bristle in self.bristles if bristle is not None]
        return tuple(nap(self.profile, bristle, stiff) for bristle in known)

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

        >>> fit = fx.fit_profile(fx.Target(scene.bristle, rho_plus=0.12, rho_minus=-0.05))
        >>> laws = [fx.friction(surface, scene.bristle) for surface in fit.family(count=3)]
        >>> [round(float(law.rho_minus), 4) for law in laws]
        [-0.05, -0.05, -0.05]
        """
        require_whole("count", count)
        require_whole("seed", seed, 0)
        require_real("size", size, "a number > 0", lambda v: v > 0)
        apart = effects_of_scene(self.effects, Engine.DESIGN, ()).apart
        if apart is not None:
            return surfaces_seen_alike(apart, self.profile, count, float(size), seed)
        sharp, high = (self.bounds[k] for k in ("smallest_radius", "largest_amplitude"))
        # As arrays: another number compiles nothing.
        numbers = (
            size,
            np.inf if sharp is None else 1 / sharp,
            np.inf if high is None else high,
        )
        known: Any = (
            waves_of_heights(self.profile.cos, self.profile.sin),
            jax.random.split(jax.random.PRNGKey(seed), count),
            *(np.asarray(number, dtype=float) for number in numbers),
        )
        waves, good = members(*known)
        cos, sin = (np.asarray(rows) for rows in heights_of_waves(waves))
        return [Fourier(cos[i], sin[i]) for i in np.flatnonzero(np.asarray(good))]

    def plot(self, ax: Any = None, figure: Any = None) -> Any:
        """The surface, what is left open, the starts and the targets, as a Figure.

        `figure`: a matplotlib Figure or SubFigure to draw into; `ax` is refused, as the
        picture has several axes.

        >>> fit = fx.fit_profile(fx.Target(scene.bristle, rho_plus=0.12, rho_minus=-0.05))
        >>> [axes.get_xlabel() for axes in fit.plot().axes]
        ['y (periods)', 'y (periods)', 'start, best first (1)', 'target (N)']
        """
        require_no_axes(ax)
        from ...plot import draw_profile_fit

        return draw_profile_fit(self, figure=figure)

    def _numbers(self) -> list[Named]:
        forces = [(found.rho_plus, found.rho_minus) for found in self.coefficients]
        told = named_forces("rho", forces, self.targets)
        told += [Named(name, value, "", "free") for name, value in self.free.items()]
        bound = f"int w''^2; at least {as_text(self.bending_bound)}, proven"
        return [
            *told,
            Named("bending_energy", self.bending_energy, "", bound),
            Named("largest_error", self.largest_error, "", "relative, of a target"),
            Named("rank", self.rank, "", "of what targets say about the surface"),
        ]

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
        known = [(found, part) for found, part in both if found.alpha is not None]
        pulls = [pulling_text(found.alpha, part) for found, part in known]
        rows += [f"  {text}" for text in dict.fromkeys(pulls) if text]
        return "\n".join(rows)
