"""Mean and peak friction of steady slides against speed."""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from jaxtyping import Float, Int

from .._checks import (
    Outcome,
    is_concrete,
    require,
    require_flags,
    require_numbers,
    require_real,
    viscosity_of,
    with_nan,
)
from .._compile import waiting
from ..design import slides_at_speeds
from ..effects import CompliantArray, Engine, noise_among
from ..model import Scene, require_friction, require_reach, require_told_apart, scene_for
from ..stochastic import SmoluchowskiStatus, smoluchowski_friction
from ..supports import Spring
from ..wiggly import Status

if TYPE_CHECKING:
    import xarray as xr

_MEANING = {
    "speed": ("m/s", "speed of the support, to the right where positive"),
    "mean_force": ("N", "mean over a period of the force in the spring"),
    "drag": ("N", "viscosity times speed"),
    "friction_force": ("N", "mean force less drag"),
    "peak_force": ("N", "largest force in the spring"),
    "temperature": ("J/m^exponent", "temperature of effects.Noise"),
    "thermal_energy": ("J", "temperature eps^exponent"),
    "error": ("N", "estimated error of the mean force"),
}


class _Slides(NamedTuple):
    """Forces in N, each of shape (speeds,) or (temperatures, speeds), and how they ended;
    `error` where estimated."""

    mean_force: Float[np.ndarray, "*slides"]
    peak_force: Float[np.ndarray, "*slides"]
    codes: Int[np.ndarray, "*slides"]
    outcomes: type[Outcome]
    error: Float[np.ndarray, "*slides"] | None


@with_nan
def friction_curve(
    scene: Scene,
    speeds: Any,
    eps: Any,
    gamma: Any = 1.0,
    temperatures: Any = None,
    *,
    progress: bool = False,
) -> "xr.Dataset":
    """Friction of steady slides whose support moves at constant speed.

    `speeds`: in m/s, one or an array of shape (n,), negative to the left, not 0; `eps` in
    m, `gamma` > 0. Of the `scene` its surface, bristle and effects are used, and the spring
    that the tip is held by: the load is that of the moving support, `l = k v t`, in place
    of the scene's, and no transient enters.

    Returns a data set over `speed`: `mean_force` (of `l - Phi'(z)`, over a period), `drag`
    (eps^gamma speed), `friction_force` (their difference), `peak_force`, all in N and
    negative to the left; `status` (flags in its attributes). With `effects.Noise` means are
    over noise too, by Smoluchowski's equation, with their estimated `error`; a largest
    force there is none then, and `peak_force` is NaN; a speed may be 0, and forces are.
    `temperatures`: of the scene's `Noise`, in its place, one or shape (m,), in J per
    m^exponent; variables are then over `temperature` and `speed`, and `thermal_energy` is
    `T_eps` in J. `fx.plot.draw_friction_curve` draws them.

    With `effects.CompliantArray` forces are means over its bristles, as attributes say: of
    a slide that of one, as each does at other times what one does; `peak_force` is lower.

    `progress`: a line on standard error where it takes more than two seconds.

    Raises `ValueError` for arguments out of range, and supports that are no `Spring`. A
    slide that is not found has its status; so has one whose force may be off by more than
    3e-4, as its spring is too soft for errors to be forgotten (`Status.OPEN_BRACKET`).

    >>> data = fx.friction_curve(scene, speeds=[0.01, 1.0, -1.0], eps=0.01)
    >>> print(data.friction_force.values.round(4), data.friction_force.units)
    [ 0.1158  0.1089 -0.0778] N
    """
    scene = scene_for(Engine.FRICTION_CURVE, scene)
    require_flags(progress=progress)
    spring = _spring_of(scene)
    known = is_concrete(scene, speeds, eps, gamma)
    require(known, "scene", "traced numbers", "known ones; steady_slide has derivatives")
    require_real("eps", eps, "eps > 0 in m", lambda v: v > 0)
    require_real("gamma", gamma, "gamma > 0", lambda v: v > 0)
    noise = noise_among(scene.effects)
    needs = "speeds in m/s, not 0" if noise is None else "speeds in m/s"
    require_numbers("speeds", speeds, needs, lambda v: (v != 0) | (noise is not None))
    asked = np.atleast_1d(np.asarray(speeds, dtype=float))
    require(asked.ndim == 1, "speeds", f"shape {asked.shape}", "one, or shape (n,)")
    require_reach(scene.potential, eps)
    require_told_apart(scene, eps)
    size, power = float(eps), float(gamma)
    drag = viscosity_of(size, power) * asked
    numbers = {"eps": size, "gamma": power}
    coords: dict[str, Any] = {"speed": asked}
    if noise is None:
        needs = "None, or a scene with effects.Noise"
        require(temperatures is None, "temperatures", temperatures, needs)
        require_friction(scene)
        with waiting("friction_curve", progress) as tell:
            tell(f"{asked.size} slides")
            phases = _phases_of(scene)
            slides = _plain(scene, spring, asked, size, power, phases)
        found = _data_set(slides, drag, coords, numbers)
        return found if phases is None else found.assign_attrs(_told_of(phases))
    if temperatures is None:
        energies = np.asarray(float(noise.temperature_at(size)))
    else:
        rows = _temperatures(temperatures)
        energies = rows * float(noise.temperature_at(size)) / float(noise.temperature)
        coords |= {"temperature": rows, "thermal_energy": ("temperature", energies)}
        energies = energies[:, None]
    with waiting("friction_curve", progress) as tell:
        tell(f"{asked.size * energies.size} slides with noise")
        slides = _with_noise(scene, spring, energies, asked, size, power)
    return _data_set(slides, drag, coords, numbers)


def _temperatures(given: Any) -> Float[np.ndarray, " temperatures"]:
    needs = "temperatures > 0 in J per m^exponent"
    require_numbers("temperatures", given, needs, lambda T: (T > 0) & np.isfinite(T))
    known = np.atleast_1d(np.asarray(given, dtype=float))
    fits = known.ndim == 1
    require(fits, "temperatures", f"shape {known.shape}", "one, or shape (m,)")
    return known


def _spring_of(scene: Scene) -> Spring:
    support = scene.support
    if isinstance(support, Spring):
        return support
    springs = "needs a Spring: with others there is no steady slide"
    raise ValueError(f"scene.support = {type(support).__name__!r}: {springs}")


def _phases_of(scene: Scene) -> Float[np.ndarray, " bristles"] | None:
    array = next((e for e in scene.effects if isinstance(e, CompliantArray)), None)
    return None if array is None else np.asarray(array.offsets, dtype=float)


def _told_of(phases: Float[np.ndarray, " bristles"]) -> dict[str, Any]:
    forces = "means over bristles: mean_force is that of one, peak_force of their mean"
    return {"bristles": phases.size, "forces": forces}


def _plain(
    scene: Scene,
    spring: Spring,
    speeds: Float[np.ndarray, " speeds"],
    eps: float,
    gamma: float,
    phases: Float[np.ndarray, " bristles"] | None,
) -> _Slides:
    found = slides_at_speeds(
        scene.potential,
        speeds,
        eps=eps,
        gamma=gamma,
        stiffness=float(spring.stiffness),
        phases=phases,
    )
    mean, peak, codes = (np.asarray(v) for v in (found.mean, found.peak, found.code))
    return _Slides(mean, peak, codes, Status, None)


def _with_noise(
    scene: Scene,
    spring: Spring,
    energies: Float[np.ndarray, "*temperatures"],
    speeds: Float[np.ndarray, " speeds"],
    eps: float,
    gamma: float,
) -> _Slides:
    found = smoluchowski_friction(
        scene.potential,
        spring,
        speeds,
        eps=eps,
        viscosity=float(viscosity_of(eps, gamma)),
        temperature=energies,
    )
    none = np.full(found.codes.shape, np.nan)
    kind = SmoluchowskiStatus
    return _Slides(found.mean_force, none, found.codes, kind, found.error)


def _data_set(
    slides: _Slides,
    drag: Float[np.ndarray, " speeds"],
    coords: dict[str, Any],
    numbers: dict[str, float],
) -> "xr.Dataset":
    import xarray as xr

    dims = ("temperature", "speed")[-slides.codes.ndim :]
    columns = {
        "mean_force": slides.mean_force,
        "friction_force": slides.mean_force - drag,
        "peak_force": slides.peak_force,
    }
    if slides.error is not None:
        columns["error"] = slides.error
    data = xr.Dataset(
        {name: (dims, values) for name, values in columns.items()}
        | {"drag": ("speed", drag)},
        coords=coords,
    )
    for name in data.variables:
        units, meaning = _MEANING[str(name)]
        data[name].attrs = {"units": units, "long_name": meaning}
    told = {"long_name": "how a slide ended", **slides.outcomes.flags()}
    data["status"] = dims, slides.codes.astype(np.int8), told
    return data.assign_attrs(title="Friction of steady slides against speed", **numbers)
