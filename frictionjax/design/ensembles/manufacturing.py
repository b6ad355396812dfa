"""Manufacturing tolerance: how friction spreads when parts do."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import xarray as xr
from jaxtyping import Array, Bool, Float

from ..._checks import (
    as_text,
    known_numbers,
    require,
    require_flags,
    require_whole,
    require_x64,
    with_nan,
)
from ..._compile import Program, waiting
from ...bristles import AbstractBristle
from ...effects import AbstractEffect, Engine, RigidArray
from ...model import BristlePotential, friction, potential
from ...profiles import AbstractProfile
from ...supports import Spring
from ...wiggly import Status
from ..common import (
    QUANTITIES,
    FreeParameter,
    SceneEffects,
    effects_of_scene,
    entries_of,
    free_parameter,
    on_slopes,
    quantity_of,
    side_of,
    slopes_of,
    surface_for,
    with_arrays,
)
from ..slide import MEANINGS, SlideNumbers, slide_numbers, slides_of_designs
from .settings import SETTINGS
from .tolerance_table import Tolerance

_QUANTILES = (0.025, 0.25, 0.5, 0.75, 0.975)


class _Spread(NamedTuple):
    """One number that spreads: of the bristle or of the profile, and its std."""

    name: str
    of_profile: bool
    number: FreeParameter
    std: float


@Program
def _sampled(
    numbers: tuple,
    of_profile: tuple,
    bristle: AbstractBristle,
    profile: AbstractProfile,
    apart: RigidArray | None,
    values: Float[Array, "n m"],
) -> tuple[Float[Array, "n 4"], Float[Array, " n"]]:
    """The four quantities (n, 4) at values (n, m) of the numbers, and alpha's side (n,)."""
    grounds = any(of_profile)
    still = None if grounds else slopes_of(surface_for(apart, profile))

    def one(row: Array) -> tuple[Array, Array]:
        part, surface = _changed(numbers, of_profile, bristle, profile, row)
        slopes = slopes_of(surface_for(apart, surface)) if still is None else still
        found = on_slopes(part, slopes)
        side = jnp.where(slopes.minus < 0, side_of(part, found), 0.0)
        side = jnp.where((slopes.plus > 0) & _in_range(numbers, row), side, 0.0)
        return jnp.stack([quantity_of(found, i) for i in range(4)]), side

    return jax.vmap(one)(values)


@Program
def _jacobian(
    numbers: tuple,
    of_profile: tuple,
    bristle: AbstractBristle,
    profile: AbstractProfile,
    apart: RigidArray | None,
    values: Float[Array, " m"],
) -> Float[Array, "4 m"]:
    """Derivatives (4, m) of the quantities by the numbers."""

    def one(row: Array) -> Array:
        part, surface = _changed(numbers, of_profile, bristle, profile, row)
        found = on_slopes(part, slopes_of(surface_for(apart, surface)))
        return jnp.stack([quantity_of(found, i) for i in range(4)])

    return jax.jacrev(one)(values)


def _changed(
    numbers: tuple,
    of_profile: tuple,
    bristle: AbstractBristle,
    profile: AbstractProfile,
    row: Float[Array, " m"],
) -> tuple[AbstractBristle, AbstractProfile]:
    for i, (number, there) in enumerate(zip(numbers, of_profile, strict=True)):
        if there:
            profile = number.put(profile, row[i])
        else:
            bristle = number.put(bristle, row[i])
    return bristle, profile


def _in_range(numbers: tuple, row: Float[Array, " m"]) -> Bool[Array, ""]:
    """Whether constructors would take the numbers."""
    good = jnp.asarray(True)
    for i, number in enumerate(numbers):
        low, high = number.own_range
        good = good & (row[i] > low) & (row[i] < high)
    return good


@with_nan
def tolerance(
    profile: AbstractProfile,
    bristle: AbstractBristle,
    spreads: Mapping[str, Any],
    samples: int = 10_000,
    seed: int = 0,
    quantiles: Any = _QUANTILES,
    *,
    eps: Any = None,
    gamma: Any = 1.0,
    rate: Any = 1.0,
    support: Spring | None = None,
    effects: Sequence[AbstractEffect] = (),
    progress: bool = False,
) -> Tolerance:
    """Friction of parts whose numbers spread normally and independently.

    `spreads`: standard deviations by name, in the number's own unit: of the `bristle` as in
    `fit_angle` (`"angle"`, `"height"`...), of the profile with `"profile."` before
    (`"profile.slope"`, `"profile.sin[0]"`; `"profile.sin"`: one for all, or an array).
    `samples`, `seed`: of the Monte Carlo, of which `quantiles` are told. Beside it stands
    the first-order estimate (delta method), which is right where spreads are small.

    Samples that no bristle could follow, or with a number out of its range, are counted,
    and left out of mean, std and quantiles. Those that pull where the nominal part presses
    (alpha < 0: contact has to be held) are counted as `flipped`, and stay in.

    `eps` (m): how the steady slides there spread too, with `gamma`, `rate` and `support` as
    in `steady_slide`, in the same samples: `slide_nominal`, `slide_mean`, `slide_std`,
    `slide_quantiles`, `slide_samples` of four forces in N, and the `status` of each sample.
    About 10 ms of a core a sample: 200 to 1000 do.

    `effects`: of the scene, as in `design_map`; all bristles of an array are alike in a
    sample.

    `progress`: a line on standard error where it takes more than two seconds.

    Returns a `Tolerance`, whose `.data` is a data set over `quantity`: `nominal`, `mean`,
    `std`, `first_order` and `quantiles` of rho_plus and rho_minus in N, of ratio and
    difference (N) as in `design_map`, and the `samples`; `.inadmissible` and `.flipped`,
    shares of these.

    Raises `ValueError` as `friction` does for the nominal parts, and for unknown names,
    spreads that are negative or not finite, counts below 2, numbers of a slide without an
    eps, and other effects, by name.

    >>> fx.tolerance(scene.profile, scene.bristle, {"angle": 0.02})
    10000 samples, 0.000% inadmissible and left out
                  nominal        mean         std  first_order        2.5%       25.0% ...
      rho_plus   0.120394    0.119579  0.00809636   0.00791109    0.101598    0.114549 ...
     rho_minus  -0.087947  -0.0873954  0.00710442     0.007014  -0.0999308  -0.0924012 ...
         ratio    1.36894     1.36982   0.0192966    0.0192236     1.33394     1.35646 ...
    difference  0.0324472   0.0321834  0.00102357  0.000897093   0.0295276   0.0316982 ...
    """
    require_x64(potential(profile, bristle))
    scene = effects_of_scene(effects, Engine.DESIGN_MAP, [bristle])
    scene.surface(profile)  # raises where it leaves no friction
    bristle, profile = with_arrays(bristle), with_arrays(profile)
    spread = _spreads(bristle, profile, spreads)
    require_flags(progress=progress)
    require_whole("samples", samples, 2)
    require_whole("seed", seed, 0)
    levels = known_numbers(quantiles)
    good = levels.ndim == 1 and np.all((levels >= 0) & (levels <= 1))
    require(good, "quantiles", quantiles, "numbers in [0, 1], shape (n,)")
    law = friction(profile, bristle)  # raises where the nominal parts are inadmissible
    asked = slide_numbers(eps, gamma, rate, support, scene.effects)
    with waiting("tolerance", progress) as tell:
        tell(f"{samples} samples")
        found = _dataset(profile, bristle, spread, samples, seed, levels, asked, scene)
    return Tolerance(found.assign_attrs(alpha=float(scene.of_all(law.alpha))))


def _dataset(
    profile,
    bristle,
    spread,
    samples,
    seed,
    levels,
    asked: SlideNumbers | None,
    scene: SceneEffects,
) -> xr.Dataset:
    where = tuple(s.of_profile for s in spread)
    numbers = tuple(s.number for s in spread)
    own = [float(s.number.now(profile if s.of_profile else bristle)) for s in spread]
    stds = np.array([s.std for s in spread])
    draws = np.random.default_rng(seed).standard_normal((samples, len(spread)))
    values = np.vstack([own, own + stds * draws])
    size = min(SETTINGS.chunk, samples)
    short = np.pad(values, ((0, -len(values) % size), (0, 0)), mode="edge")
    parts = [
        _sampled(numbers, where, bristle, profile, scene.apart, short[at : at + size])
        for at in range(0, len(short), size)
    ]
    share = np.array([scene.of_all(1.0, name) for name in QUANTITIES])
    found = share * np.concatenate([np.asarray(p[0]) for p in parts])[: samples + 1]
    side = np.concatenate([np.asarray(p[1]) for p in parts])[: samples + 1]
    slopes = _jacobian(numbers, where, bristle, profile, scene.apart, values[0])
    slopes = share[:, None] * np.asarray(slopes)
    columns = _statistics(np.where(side[:, None] != 0, found, np.nan), levels, "quantity")
    columns |= {
        "first_order": (
            "quantity",
            np.sqrt(slopes**2 @ stds**2),
            {"long_name": "standard deviation by the delta method"},
        ),
        "by_number": (
            ("quantity", "number"),
            np.abs(slopes) * stds,
            {"long_name": "first-order std that a number alone would cause"},
        ),
        "inadmissible": _share(side[1:] == 0, "of samples that cannot follow"),
        "flipped": _share(side[1:] * side[0] < 0, "of samples of another sign of alpha"),
    }
    coords = {
        "quantity": list(QUANTITIES),
        "unit": ("quantity", ["1" if name == "ratio" else "N" for name in QUANTITIES]),
        "quantile": levels,
        "number": [s.name for s in spread],
    }
    data = xr.Dataset(columns, coords, attrs={"seed": seed})
    if asked is None:
        return data
    designs = [
        _as_design(numbers, where, bristle, profile, row) if good else None
        for row, good in zip(values, side != 0, strict=True)
    ]
    return data.assign(_slide_columns(designs, asked, scene.effects, levels)).assign_attrs(
        asked.attributes()
    )


def _as_design(numbers, where, bristle, profile, row) -> BristlePotential:
    part, surface = _changed(numbers, where, bristle, profile, jnp.asarray(row))
    return BristlePotential(surface, part)


def _slide_columns(
    designs: list, asked: SlideNumbers, effects: Any, levels: Float[np.ndarray, " q"]
) -> dict[str, tuple]:
    """How the slides of designs spread, the nominal one first."""
    slides = slides_of_designs(designs, asked, effects)
    forces = np.stack([slides.forces[name] for name in MEANINGS], axis=1)
    good = slides.status == int(Status.OK)
    spread = _statistics(np.where(good[:, None], forces, np.nan), levels, "force")
    told = {"long_name": "how the slides ended", **Status.flags()}
    return {
        "force": ("force", list(MEANINGS)),
        **{
            f"slide_{name}": (dims, values, meaning | {"units": "N"})
            for name, (dims, values, meaning) in spread.items()
        },
        "status": ("sample", slides.status[1:].astype(np.int8), told),
    }


def _statistics(
    values: Float[np.ndarray, " n m"], levels: Float[np.ndarray, " q"], over: str
) -> dict[str, tuple]:
    """Of parts as they are, the first row, and of how the others spread; NaN left out."""
    drawn = values[1:]
    known = drawn[~np.isnan(drawn[:, 0])]
    blank, few = np.full(values.shape[1], np.nan), len(known) < 2
    cuts = [blank] * levels.size if few else np.quantile(known, levels, axis=0)
    found: dict[str, tuple] = {
        "nominal": (over, values[0], "parts as they are"),
        "mean": (over, blank if few else known.mean(axis=0), "mean of samples"),
        "std": (
            over,
            blank if few else known.std(axis=0, ddof=1),
            "standard deviation of samples",
        ),
        "quantiles": (("quantile", over), np.asarray(cuts), "quantiles of samples"),
        "samples": (("sample", over), drawn, "samples, NaN where left out"),
    }
    return {n: (*column, {"long_name": told}) for n, (*column, told) in found.items()}


def _share(there: Bool[np.ndarray, " n"], of_what: str) -> tuple:
    return (), float(np.mean(there)), {"units": "1", "long_name": f"share {of_what}"}


def _spreads(bristle, profile, spreads: Any) -> list[_Spread]:
    given = isinstance(spreads, Mapping) and len(spreads) > 0
    what = "no name" if isinstance(spreads, Mapping) else type(spreads).__name__
    require(given, "spreads", what, "standard deviations by name, one or more")
    found = [
        one for name, std in spreads.items() for one in _one(bristle, profile, name, std)
    ]
    require(any(s.std for s in found), "spreads", "all 0", "a standard deviation > 0")
    return found


def _one(bristle, profile, name: str, std: Any) -> list[_Spread]:
    """The spreads that one entry stands for: of one number, or of an array of them."""
    array = known_numbers(std)
    numeric = array.dtype != object
    allowed = "finite standard deviations >= 0"
    label = f"spreads[{name!r}]"
    require(
        numeric and np.all(np.isfinite(array)) and np.all(array >= 0), label, std, allowed
    )
    there = name.startswith("profile.")
    inner = name.removeprefix("profile.").removeprefix("bristle.")
    part = profile if there else bristle
    entries = entries_of(part, inner)
    if not entries:
        require(array.ndim == 0, label, std, "one number")
        number = free_parameter(part, inner, "spreads" + " of the profile" * there)
        return [_Spread(name, there, number, float(array))]
    fits = array.ndim == 0 or array.shape == (len(entries),)
    require(fits, label, as_text(array), f"one number, or {len(entries)} of them")
    each = np.broadcast_to(array.astype(float), (len(entries),))
    prefix = "profile." if there else ""
    return [
        _Spread(
            prefix + entry, there, free_parameter(profile if there else bristle, entry), s
        )
        for entry, s in zip(entries, each.tolist(), strict=True)
    ]
