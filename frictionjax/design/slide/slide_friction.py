"""The friction that a steady slide shows at a given eps, gamma and rate."""

import dataclasses
from collections.abc import Sequence
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..._checks import (
    CodedResult,
    Real,
    as_jax,
    as_real,
    as_text,
    checked,
    is_concrete,
    is_known,
    kind_of,
    require,
    require_flags,
    require_numbers,
    require_real,
    require_x64,
    with_nan,
)
from ..._compile import padded_size, waiting
from ..._text import Named, SelfDrawn, ShownNumbers
from ...bristles import AbstractBristle
from ...effects import (
    AbstractEffect,
    CompliantArray,
    Engine,
    require_done,
    require_together,
)
from ...io import CODES, LEAF, record
from ...model import (
    AbstractPotential,
    SummedPotential,
    coefficients_jit,
    potential,
    require_admissible,
    require_reach,
    with_effects,
)
from ...profiles import AbstractProfile
from ...supports import Spring
from ...wiggly import Status
from .differentiable_slides import AskedSlides, differentiable_sides, slides_both_ways
from .settings import SETTINGS
from .slide_curve import array_peaks, require_bristles, with_peaks
from .slide_rows import find_both_ways, slide_table
from .slide_sides import Sides

SLIDE_FORCES = ("mean", "peak")  # of a slide, that designs may ask for


class SteadySlide(ShownNumbers, SelfDrawn, CodedResult, eqx.Module):
    """Forces in the spring while a tip slides steadily, of the shape of `eps`.

    `mean_plus`, `peak_plus` (N, > 0): mean over time, and largest, of `l - Phi'(z)` in a
    slide to the right; `mean_minus`, `peak_minus` (N, < 0) to the left. All tend to
    rho_plus and rho_minus with eps. `code_plus`, `code_minus`: a `Status` as an integer,
    `status` the worse of the two.
    """

    eps: Real
    mean_plus: Real
    mean_minus: Real
    peak_plus: Real
    peak_minus: Real
    code_plus: Real
    code_minus: Real
    _outcomes = Status
    _picture = "draw_steady_slide"

    @property
    def ratio(self) -> Real:
        """`-mean_plus/mean_minus`, which tends to `-rho_plus/rho_minus`."""
        return -self.mean_plus / self.mean_minus

    @property
    def _codes(self) -> Any:
        by = np if is_known(self.code_plus, self.code_minus) else jnp
        return by.maximum(self.code_plus, self.code_minus)

    def _in_words(self) -> str:
        names = ("eps", "mean_plus", "mean_minus", "peak_plus", "peak_minus")
        known = ", ".join(f"{name}={as_text(getattr(self, name))}" for name in names)
        return f"SteadySlide({known}, status={self._ended})"

    def _numbers(self) -> list[Named]:
        return [
            Named("eps", self.eps, "m", "period of the wiggles"),
            Named("mean_plus", self.mean_plus, "N", "over time, to the right"),
            Named("mean_minus", self.mean_minus, "N", "over time, to the left"),
            Named("peak_plus", self.peak_plus, "N", "largest, to the right"),
            Named("peak_minus", self.peak_minus, "N", "largest, to the left"),
            Named("ratio", self.ratio, "", "-mean_plus/mean_minus"),
        ]


SLIDE = record(
    SteadySlide,
    [field.name for field in dataclasses.fields(SteadySlide)],
    LEAF,
    code_plus=CODES,
    code_minus=CODES,
)
"""A slide in a document."""


class SlideForces(NamedTuple):
    """Forces of slides to the right and to the left."""

    rho_plus: Real
    rho_minus: Real


def slide_at(potential, eps: Real, gamma: Real, rate: Real, stiffness: Real) -> SteadySlide:
    """The steady slide at one eps; without checks, traceable."""
    both = slides_both_ways(potential, gamma, rate, stiffness, eps)[0]
    return _joined(eps, where_found(both, jnp))


_NOT_FOUND = [int(s) for s in (Status.MAX_STEPS, Status.NOT_FINITE, Status.SOLVER_FAILED)]


def where_found(both: Sides, by: Any) -> Sides:
    """Forces, and derivatives of them, NaN where none is found; `by` NumPy or JAX."""
    found = by.where(by.isin(both.code, by.asarray(_NOT_FOUND)), by.nan, 1.0)
    return both._replace(mean=both.mean * found, peak=both.peak * found)


def _joined(eps: Real, both: Sides) -> SteadySlide:
    """Forces and codes as columns."""
    parts = both.mean, both.peak, both.code
    return SteadySlide(eps, *(part[..., side] for part in parts for side in (0, 1)))


def require_force(force: str) -> None:
    """Raise `ValueError` unless designs know this force."""
    require(force in SLIDE_FORCES, "force", force, "'mean' or 'peak'")


def forces_of(slide: SteadySlide, force: str) -> SlideForces:
    """Its mean or its peak forces."""
    plus, minus = getattr(slide, f"{force}_plus"), getattr(slide, f"{force}_minus")
    return SlideForces(plus, minus)


def spring_of(support: Spring | None) -> Spring:
    """The support, of 1 N/m where none is given; raises `ValueError` for other kinds."""
    if support is None:
        return Spring(as_real(1.0))
    known = isinstance(support, Spring)
    require(known, "support", kind_of(support), "a frictionjax.supports.Spring")
    return checked(support)


def wiggle_of(
    profile: AbstractProfile, bristle: AbstractBristle, effects: Any
) -> AbstractPotential:
    """The potential of a slide with these effects.

    Raises `ValueError` for parts of another kind, and effects that slides do not do.
    """
    listed = isinstance(effects, list | tuple)
    good = listed and all(isinstance(effect, AbstractEffect) for effect in effects)
    require(good, "effects", effects, "effects of frictionjax.effects in a tuple")
    known = [checked(effect) for effect in effects]
    require_together(known)
    require_done(known, Engine.SLIDE)
    return with_effects(potential(profile, bristle), known)


def _require_friction(wiggle: AbstractPotential) -> None:
    if is_concrete(wiggle):
        rho = float(coefficients_jit(wiggle).rho_plus)
        require(rho > 0, "effects: rho_plus", rho, "tips whose forces do not cancel")


@with_nan
def steady_slide(
    profile: AbstractProfile,
    bristle: AbstractBristle,
    eps: Any,
    gamma: Any = 1.0,
    rate: Any = 1.0,
    support: Spring | None = None,
    effects: Sequence[AbstractEffect] = (),
    *,
    progress: bool = False,
) -> SteadySlide:
    """Mean and peak force of a steady slide of a `bristle` on a `profile`, both ways.

    `eps` (m): a number or an array of shape (n,). `gamma`: exponent of the viscosity
    eps^gamma. `rate` (N/s, > 0): of the load, so that the tip moves at rate/k_h on
    average. `support`: a `Spring`, of 1 N/m where none is given. `effects`: those that
    change the potential, `effects.LeadingOrder` and `effects.RigidArray`, whose tips pull
    at one spring together, and `effects.CompliantArray`, of which forces are means over
    bristles: of a slide that of one, at any phases, as each does at other times what one
    does; peaks are lower. Times N it is what the root feels of all. Of known numbers only.

    One period is integrated, to its fixed point: see `slide_period`. No transient and no
    number of slips enters, and derivatives (first ones, in every number of the parts and
    in eps, gamma, rate) are those of the fixed point. Where rate eps^(gamma+1) is below
    2e-15 of the steepest wiggle, squared, that takes its place. Where that adds more than
    1e-5 of a force, as on bristles with ratios in the hundreds, the status is
    `STEP_TOO_SMALL`. Where the spring is so soft that errors are hardly forgotten in a
    period, and may add up to 3e-4 of the force, it is `OPEN_BRACKET`.

    `progress`: a line on standard error where it takes more than two seconds.

    Returns a `SteadySlide`: `.mean_plus .mean_minus .peak_plus .peak_minus` in N, of the
    shape of `eps`, `.ok`, `.status`.

    Raises `ValueError` as `friction` does, for an eps above which `G > 0` fails, for
    numbers that are not positive, for other effects, and for tips of an array whose forces
    cancel. A slide that is not found has forces of NaN, and its `status`.

    >>> slide = fx.steady_slide(scene.profile, scene.bristle, eps=0.01)
    >>> print(f"{slide.mean_plus:.4f} N, {slide.mean_minus:.4f} N: {slide.status.name}")
    0.1189 N, -0.0878 N: OK
    """
    require_flags(progress=progress)
    support = spring_of(support)
    wiggle = wiggle_of(profile, bristle, effects)
    require_x64(wiggle, support)
    require_numbers("eps", eps, "eps > 0, one or an array of shape (n,)", lambda v: v > 0)
    require_real("gamma", gamma, "gamma > 0", lambda v: v > 0)
    require_real("rate", rate, "rate > 0", lambda v: v > 0)
    require_admissible(potential(profile, bristle))
    _require_friction(wiggle)
    sizes = jnp.asarray(eps, dtype=float)
    require(sizes.ndim < 2, "eps", f"shape {sizes.shape}", "a number or shape (n,)")
    require_reach(wiggle, eps)
    numbers = as_real(gamma), as_real(rate), support.stiffness
    several = jnp.atleast_1d(sizes)
    array = next((e for e in effects if isinstance(e, CompliantArray)), None)
    if is_concrete(wiggle, several, numbers, array):
        with waiting("steady_slide", progress) as tell:
            tell(f"{several.size} eps, both ways")
            found = _known_forces(wiggle, np.asarray(several), numbers, array)
    else:
        one = "known numbers; traced, a slide of one bristle, whose mean force it has"
        require(array is None, "effects.CompliantArray", "traced numbers", one)
        found = _forces_of(wiggle, several, numbers)
    wanted = slice(None) if sizes.ndim else 0
    return _joined(sizes, jax.tree_util.tree_map(lambda leaf: leaf[wanted], found))


def _known_forces(
    wiggle: AbstractPotential,
    eps: Float[np.ndarray, " n"],
    numbers: tuple[Real, Real, Real],
    array: CompliantArray | None,
) -> Sides:
    """Of known parts, by their tables: one program for all of them, arrays (n, 2)."""
    if isinstance(wiggle, SummedPotential):
        tables = [slide_table(wiggle, float(e)) for e in eps]
        which = np.arange(eps.size)
    else:
        tables, which = [slide_table(wiggle, float(eps.max()))], np.zeros(eps.size, int)
    gamma, rate, stiffness = (float(number) for number in numbers)
    found = find_both_ways(tables, which, eps, gamma, rate, stiffness)
    if array is not None:
        cells = [(tables[i], float(e)) for i, e in zip(which, eps, strict=True)]
        found = _of_many(found, cells, (gamma, rate, stiffness), np.asarray(array.offsets))
    return Sides(*(as_jax(column) for column in where_found(found, np)))


def _of_many(
    one: Sides,
    cells: list[tuple[AbstractPotential, float]],
    numbers: tuple[float, float, float],
    phases: Float[np.ndarray, " bristles"],
) -> Sides:
    """Means over bristles at these phases, of the slides of one in each cell (n, 2)."""
    require_bristles(phases)
    if np.all(phases == phases[0]):
        return one
    rows = [array_peaks(table, eps, numbers, phases) for table, eps in cells]
    return with_peaks(one, *(np.stack(column) for column in zip(*rows, strict=True)))


def _forces_of(
    wiggle: AbstractPotential, eps: Float[Array, " n"], numbers: tuple[Real, Real, Real]
) -> Sides:
    """Of all eps (m), in rooms of a few sizes; `numbers`: gamma, rate, stiffness."""
    count = eps.shape[0]
    more = padded_size(count, 1, SETTINGS.room) - count
    padded = jnp.pad(eps, (0, more), mode="edge")
    found = where_found(differentiable_sides(AskedSlides(wiggle, *numbers, padded)), jnp)
    return jax.tree_util.tree_map(lambda leaf: leaf[:count], found)
