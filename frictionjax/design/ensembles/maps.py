"""Friction over a plane of designs: bristle against surface, or any two numbers."""

from collections.abc import Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import xarray as xr
from jaxtyping import Array

from ..._checks import (
    checked,
    kind_of,
    known_numbers,
    require,
    require_flags,
    require_real,
    require_x64,
    with_nan,
)
from ..._compile import once_a_scene, waiting
from ...bristles import AbstractBristle
from ...effects import AbstractEffect, Engine
from ...io import MEANINGS, unit_of
from ...model import BristlePotential, coefficients_jit, potential
from ...profiles import AbstractProfile, Fourier
from ...supports import Spring
from ..common import (
    FreeParameter,
    SceneEffects,
    Slopes,
    effects_of_scene,
    free_parameter,
    on_slopes,
    quantity_of,
    side_of,
    with_arrays,
)
from ..slide import slide_numbers, slides_of_designs
from .settings import SETTINGS

SURFACE = ("asymmetry", "steepness")
_DEFAULTS = {
    "asymmetry": np.geomspace(1 / 3, 3, 121),
    "steepness": np.linspace(0.02, 0.6, 117),
    "angle": np.linspace(-1.5, 1.5, 181),
    "limit": np.linspace(0.02, 1.55, 181),
}
_MEANING = {
    "rho_plus": ("N", "friction against motion to the right, rho_plus"),
    "rho_minus": ("N", "friction against motion to the left, rho_minus"),
    "ratio": ("1", "-rho_plus/rho_minus"),
    "difference": ("N", "rho_plus + rho_minus"),
    "contrast": ("1", "(rho_plus + rho_minus)/(rho_plus - rho_minus)"),
    "alpha": ("N", "normal force without friction, alpha"),
    "admissible": (None, "whether the bristle can follow the surface, and may"),
    "pulls": (None, "whether alpha < 0: the bristle pulls on the surface"),
}

_AXES = {  # that are no number of a bristle as its constructor has it
    "asymmetry": ("1", "omega_plus/|omega_minus| of the surface"),
    "steepness": ("1", "(omega_plus - omega_minus)/2 of the surface"),
    "limit": ("rad", "angle of the rod from the vertical, theta_lim"),
}
_PULLING = (
    "no: bristles that would pull (alpha < 0) are not admissible; design_map(pulling=True)",
    "yes: bristles that pull (alpha < 0) are shown too",
)


def asymmetric_profile(steepness: float, asymmetry: float) -> Fourier:
    """A smooth profile of given mean steepness that is steeper on one side.

    `w' = steepness (1 - q^2) sum_n q^(n-1) cos(2 pi n y)`, a Poisson kernel, with
    `q = (asymmetry - 1)/(asymmetry + 1)`, has `omega_plus = steepness (1 + q)` and
    `omega_minus = -steepness (1 - q)`: `asymmetry` = omega_plus/|omega_minus| and
    `steepness` = (omega_plus - omega_minus)/2. At 1 it is a sine.

    Raises `ValueError` for numbers that are not positive, and for an asymmetry so far
    from 1 that more than 512 harmonics were needed.
    """
    for name, value in (("steepness", steepness), ("asymmetry", asymmetry)):
        require_real(name, value, f"{name} > 0", lambda v: v > 0)
    lean = (asymmetry - 1) / (asymmetry + 1)
    more = np.log(SETTINGS.smallest_wave) / np.log(abs(lean)) if lean else 0
    needed, most = 1 + int(np.ceil(more)), SETTINGS.most_waves
    require(needed <= most, "asymmetry", asymmetry, f"at most {most} harmonics")
    order = np.arange(1, needed + 1)
    slopes = steepness * (1 - lean**2) * float(lean) ** (order - 1.0)
    return Fourier(jnp.zeros(needed), jnp.asarray(slopes / (2 * np.pi * order)))


@with_nan
def design_map(
    bristle: AbstractBristle,
    x: tuple[str, Any] | str = "angle",
    y: tuple[str, Any] | str = "asymmetry",
    profile: AbstractProfile | None = None,
    steepness: float = SETTINGS.steepness,
    pulling: bool = False,
    *,
    eps: Any = None,
    gamma: Any = 1.0,
    rate: Any = 1.0,
    support: Spring | None = None,
    effects: Sequence[AbstractEffect] = (),
    progress: bool = False,
) -> xr.Dataset:
    """Friction over two numbers of a design, all in one compiled call.

    `x`, `y`: a name, or a name and its values, shape (n,). Names of the `bristle`'s numbers
    are those of `fit_angle`; `"asymmetry"` = omega_plus/|omega_minus| and `"steepness"` =
    (omega_plus - omega_minus)/2 are the surface's: see `asymmetric_profile`. Angles and
    the surface's numbers have values of their own where none are given. `profile`: the
    surface where neither axis is one of its numbers; `steepness`: where only `asymmetry`
    is, 0.2 where none is given.

    Returns an `xarray.Dataset` over y and x: `rho_plus, rho_minus` (N), `ratio` =
    -rho_plus/rho_minus, `difference`, `contrast` = (rho_plus + rho_minus)/(rho_plus -
    rho_minus), in (-1, 1), above 0 where the right is harder, `alpha` (N), and
    `admissible`; NaN where that is false. `pulls`: where alpha < 0. Such bristles count as
    admissible with `pulling` only; else nothing but their alpha is given.

    `eps` (m): the steady slides of all admissible designs there too, with `gamma`, `rate`
    and `support` as in `steady_slide`: `mean_plus, mean_minus, peak_plus, peak_minus` (N)
    and `status`, `NOT_TRIED` where the design is not admissible, or the bristle loses its
    contact at this eps. About 10 ms of a core a design: choose axes for it.

    `effects`: of the scene. Of a `RigidArray` and a `CompliantArray` forces are those of
    all bristles, of tips at different phases where they stand upright and `profile` is
    given; of `LeadingOrder` slides are those of `eps W`, and arrays have none.

    `progress`: a line on standard error where it takes more than two seconds.

    Raises `ValueError` for what is no bristle, unknown names, values that are not finite or
    positive, a profile that is missing, or too much, a steepness or numbers of a slide that
    nothing is asked of, and other effects, by name.

    >>> angles, asymmetries = ("angle", [0.5, 1.0]), ("asymmetry", [1.0, 2.0])
    >>> found = fx.design_map(scene.bristle, x=angles, y=asymmetries)
    >>> print(found.ratio.values.round(3))
    [[1.245 1.905]
     [2.512 4.131]]
    """
    known = isinstance(bristle, AbstractBristle)
    require(known, "bristle", kind_of(bristle), "a part of frictionjax.bristles")
    require_x64(bristle)
    require_flags(pulling=pulling, progress=progress)
    bristle = checked(bristle)
    bristle = with_arrays(bristle)
    axes = [_axis(bristle, label, given) for label, given in (("x", x), ("y", y))]
    names = [axis[0] for axis in axes]
    require(names[0] != names[1], "y", names[1], "another name than x")
    scene = effects_of_scene(effects, Engine.DESIGN_MAP, [bristle])
    asked = slide_numbers(eps, gamma, rate, support, scene.effects)
    slopes = _base(bristle, names, profile, steepness, scene)
    frees = tuple(axis[2] for axis in axes)
    across, up = (axis[1] for axis in axes)
    flat = np.tile(across, up.size), np.repeat(up, across.size)
    surface = tuple(name if name in SURFACE else "" for name in names)
    with waiting("design_map", progress) as tell:
        found = _mapped(frees, surface, bristle, slopes, np.asarray(pulling), *flat)
        shape = up.size, across.size
        dims = names[1], names[0]
        columns = {
            name: (dims, np.asarray(_of_all(scene, name, values)).reshape(shape))
            for name, values in found.items()
        }
        if asked is not None:
            good = np.asarray(found["admissible"])
            designs = [
                _design(bristle, profile, frees, surface, slopes, values) if there else None
                for there, *values in zip(good, *flat, strict=True)
            ]
            tell(f"slides of {sum(good.ravel())} designs")
            columns |= slides_of_designs(designs, asked, scene.effects).columns(dims, shape)
    data = xr.Dataset(columns, {names[0]: across, names[1]: up})
    for name, free in zip(names, frees, strict=True):
        data[name].attrs = _told(bristle, name, free)
    for name, (units, meaning) in _MEANING.items():
        data[name].attrs = {"long_name": meaning} | ({"units": units} if units else {})
    data.attrs = {
        "bristle": type(bristle).__name__,
        "title": "Friction of designs",
        "pulling": _PULLING[bool(pulling)],
        **({} if asked is None else asked.attributes()),
    }
    return data


def _told(
    bristle: AbstractBristle, name: str, free: FreeParameter | None
) -> dict[str, str]:
    """Unit and meaning of an axis, as far as they are known of a bristle of one's own."""
    key = name if free is None else free.kind
    known = MEANINGS.get(type(bristle).__name__, {}).get(name, name)
    units, meaning = _AXES.get(key, (unit_of(bristle, name), known))
    return {"long_name": meaning} | ({"units": units} if units else {})


def _of_all(scene: SceneEffects, name: str, values: Any) -> Any:
    """A column, of all bristles where it is a force."""
    return scene.of_all(values) if _MEANING[name][0] == "N" else values


def _design(
    bristle: AbstractBristle,
    profile: AbstractProfile | None,
    frees: tuple,
    surface: tuple,
    base: np.ndarray,
    values: Sequence[float],
) -> BristlePotential:
    """One design of the map, its parts as they are."""
    ground = dict(zip(("steepness", "asymmetry"), base, strict=True))
    for free, name, value in zip(frees, surface, values, strict=True):
        if free is None:
            ground[name] = value
        else:
            bristle = free.put(bristle, jnp.asarray(value))
    if profile is None:
        profile = asymmetric_profile(ground["steepness"], ground["asymmetry"])
    return BristlePotential(profile, bristle)


def _axis(bristle, label: str, given: Any) -> tuple[str, np.ndarray, FreeParameter | None]:
    """Name, values and place in the bristle of one axis."""
    pair = (given, None) if isinstance(given, str) else given
    good = isinstance(pair, Sequence) and len(pair) == 2 and isinstance(pair[0], str)
    require(good, label, repr(given), "a name, or a name and its values")
    name, values = pair
    free = None if name in SURFACE else free_parameter(bristle, name, label, SURFACE)
    usual = _DEFAULTS.get(name if free is None else free.kind)
    if values is None:
        require(usual is not None, label, name, f"values of {name}: ({name!r}, [...])")
        values = usual
    array = known_numbers(values)
    numeric = array.dtype != object and array.ndim == 1 and array.size > 0
    require(numeric, f"{label} values", values, "numbers, shape (n,), n > 0")
    array = array.astype(float)
    positive = free is not None or bool(np.all(array > 0))
    finite = bool(np.all(np.isfinite(array)))
    require(
        finite and positive, f"{label} values", array, f"finite {name}, > 0 for surfaces"
    )
    return name, array, free


def _base(bristle, names, profile, steepness, scene: SceneEffects) -> np.ndarray:
    """Steepness and asymmetry before the axes change them."""
    own = [name for name in names if name in SURFACE]
    if profile is not None or "steepness" in names:
        kept = np.array_equal(steepness, SETTINGS.steepness)
        needs = "neither a profile nor steepness as an axis beside it"
        require(kept, "steepness", steepness, needs)
    if own or profile is None:
        require(own, "profile", None, "a surface, or asymmetry or steepness as an axis")
        require(profile is None, "profile", type(profile).__name__, f"none beside {own[0]}")
        needs = f"tips of effects.RigidArray at one phase beside {own[0]}, or a profile"
        require(scene.apart is None, "effects", "RigidArray", needs)
        require_real("steepness", steepness, "steepness > 0", lambda v: v > 0)
        return np.array([float(steepness), 1.0])
    law = coefficients_jit(potential(scene.surface(profile), bristle))
    plus, minus = float(law.omega_plus), float(law.omega_minus)
    require(minus < 0 < plus, "profile", (minus, plus), "omega_plus > 0 > omega_minus")
    return np.array([0.5 * (plus - minus), -plus / minus])


@once_a_scene
def _mapped(
    frees: tuple,
    surface: tuple,
    bristle: AbstractBristle,
    base: Any,
    pulling: Array,
    across: Array,
    up: Array,
) -> Any:
    def one(*values: Array) -> Any:
        part, ground = bristle, dict(zip(("steepness", "asymmetry"), base, strict=True))
        good = jnp.asarray(True)
        for free, name, value in zip(frees, surface, values, strict=True):
            if free is None:
                ground[name] = value
                continue
            part = free.put(part, value)
            good = good & (value > free.own_range[0]) & (value < free.own_range[1])
        lean = (ground["asymmetry"] - 1) / (ground["asymmetry"] + 1)
        slopes = Slopes(ground["steepness"] * (1 + lean), -ground["steepness"] * (1 - lean))
        law = on_slopes(part, slopes)
        side = jnp.where(good, side_of(part, law), 0.0)
        pulls = side < 0
        good = (side > 0) | (pulls & pulling)
        numbers = {
            "rho_plus": law.rho_plus,
            "rho_minus": law.rho_minus,
            "ratio": quantity_of(law, 2),
            "difference": quantity_of(law, 3),
            "contrast": quantity_of(law, 3) / (law.rho_plus - law.rho_minus),
        }
        known = {name: jnp.where(good, value, jnp.nan) for name, value in numbers.items()}
        known["alpha"] = jnp.where(good | pulls, law.alpha, jnp.nan)
        return known | {"admissible": good, "pulls": pulls}

    return jax.vmap(one)(across, up)
