"""Mechanics of a solution: where everything is, and what pushes it."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from .._checks import (
    as_real,
    is_concrete,
    require,
    require_numbers,
    require_own,
    with_nan,
)
from .._compile import Interpreted
from ..effects import Engine, NapFlip, inertia_among, nap_flip_among
from ..limit import LimitSolution
from ..loads import Pulled
from ..model import (
    SETTINGS,
    AbstractPotential,
    BristlePotential,
    Scene,
    coefficients_jit,
    require_reach,
    scene_for,
)
from ..supports import Spring
from ..turning import flipping_rod
from ..wiggly import Solution
from .axial import axial_reading
from .forces import TipForces, limit_forces, tip_forces
from .support_spring import SupportRows, support_rows
from .turned_readings import jumps_of, turning_bounds, turning_forces

_UNITS = {
    "z": ("m", "state z = u + c"),
    "u": ("m", "root of the bristle"),
    "q": ("m", "far end of the horizontal spring"),
    "p": ("m", "tip of the bristle"),
    "theta": ("rad", "angle of the bristle from the vertical, > 0 where p < u"),
    "mode": ("1", "1: the rod as it stands at first; -1: turned over; 0: in between"),
    "length": ("m", "length of the bristle; of a bent one, of its chord"),
    "normal_force": ("N", "force of the surface on the bristle, upwards"),
    "tangential_force": ("N", "force of the surface on the bristle, along x"),
    "tangential_low": ("N", "least tangential force that friction allows there"),
    "tangential_high": ("N", "greatest tangential force that friction allows there"),
    "axial_force": ("N", "force along the bristle, traction positive"),
    "compression": ("N", "force along the rod, compression positive"),
    "buckling_share": ("1", "compression over the critical load"),
    "sprung_share": ("1", "compression over the critical load of the rod on its spring"),
    "support_force": ("N", "force of the horizontal spring on the root"),
    "energy_support": ("J", "energy of the horizontal spring"),
    "energy_bristle": ("J", "energy of the bristle"),
    "energy_kinetic": ("J", "kinetic energy of what moves"),
    "power": ("W", "power put in at the far end of the horizontal spring"),
    "dissipation": ("J", "energy lost since the start"),
}
_NO_GEOMETRY = "the bristle is two functions of the height under its tip: no geometry"
_NO_BRISTLE = "the abstract setting has no bristle"
_NO_SPRING = "the support is no linear spring"
_ROOT = "the root of this bristle is known by z alone: u is z"
_UNKNOWN_REST = "rest length of the horizontal spring taken as 0"
_BENT = "of straight rods; in between it has given way"
_OTHER_SUPPORT = "Phi(z) - l z, and -l' z: of a support that is no linear spring"


@Interpreted
def _wiggly_rows(potential: AbstractPotential, z: Any, eps: Any) -> TipForces:
    return jax.vmap(lambda one: tip_forces(potential, one, eps))(z)


@Interpreted
def _limit_rows(potential: AbstractPotential, z: Any, force: Any) -> TipForces:
    return jax.vmap(lambda *one: limit_forces(potential, *one))(z, force)


@with_nan
def mechanics(scene: Scene, solution: Any, eps: Any = None) -> Any:
    """Places, forces and energies along a solution, as a data set over `time` (s).

    `solution`: what `solve` or `solve_limit` returned for this `scene`; `eps`: in m, the
    one of a wiggly solution, and none of a limit one.

    Returns `u, q, p` in m: root, far end of the horizontal spring, tip; `theta` (rad),
    `length` (m); `normal_force`, `tangential_force` (along x) of the surface on the
    bristle, `axial_force` (traction positive), `support_force` on the root, in N;
    `energy_support` and `energy_bristle` in J, and `power` in W put in at q: what energies
    gain is the integral of it less `dissipation`, which is there where the solution has it.

    A limit solution has the force that its support exerts, on slides and at rest, and
    `tangential_low`, `tangential_high`: the one of the slide twice, or at rest all that
    friction could hold. What a model does not have is NaN, with an attribute `missing`
    that says why; what is taken for granted is an attribute `note`.

    With `effects.Inertia` a wiggly solution has `energy_kinetic` (J) too, which counts
    among the energies; the bristle itself has no mass.

    With `effects.AxialLoad` also `compression` (N), `buckling_share`, it over the critical
    load, and the attributes `critical_load` (N) and `buckling`, in words.

    With `effects.NapFlip` also `mode`, `compression` and `buckling_share`. While the rod is
    in between it is an elastica over its pinned tip: theta, length and what is along it are
    those of its chord. A limit solution tells over `jump` when it jumps and what that loses
    (`jump_time`, `jump_from`, `jump_to`, `jump_loss`), which is in `dissipation` too.
    `buckling_share` is then over the load at which it turns, between two hinges; with
    `effects.AxialLoad` too, `sprung_share` is over that of the rod on its spring, in
    `sprung_load` (N) and `sprung_buckling`, NaN while it is bent.

    Raises `ValueError` for a batch of solutions, parts or an eps that are not those of the
    solution, or an effect whose forces are not those of one bristle.

    >>> forces = fx.mechanics(scene, fx.solve_limit(scene, ts=[0.0, 0.75, 3.0]))
    >>> print(forces.tangential_force.values.round(4), forces.tangential_force.units)
    [-0.     -0.1204 -0.1204] N
    """
    given, scene = scene, scene_for(Engine.MECHANICS, scene)
    in_limit = isinstance(solution, LimitSolution)
    kind = type(solution).__name__
    some = "what solve or solve_limit returned"
    require(in_limit or isinstance(solution, Solution), "solution", kind, some)
    known = is_concrete(scene, solution) and np.ndim(solution.z) == 1
    require(known, "solution", kind, "one solution with known numbers, as of no batch")
    eps = _eps_of(scene, eps, in_limit)
    require_own(solution, given, eps)
    support = support_rows(scene, solution.ts, solution.z)
    turning = nap_flip_among(scene.effects)
    if turning is not None:
        columns, system = _with_turning(scene, turning, solution, support, eps)
        jumps = jumps_of(scene, turning) if in_limit else {}
        return _data_set(scene, solution, columns, system).assign(jumps)
    if in_limit:
        forces = _limit_rows(scene.potential, solution.z, support.force)
        columns = _columns(scene, solution, forces, support) | _bounds(scene, support)
    else:
        forces = _wiggly_rows(scene.potential, solution.z, eps)
        columns = _columns(scene, solution, forces, support)
        columns |= _kinetic(scene, solution, eps)
    system = _system(eps)
    reading = axial_reading(scene, -np.asarray(columns["axial_force"], float))
    if reading is not None:
        columns |= {"compression": reading.compression, "buckling_share": reading.share}
        system |= {"critical_load": reading.critical, "buckling": reading.verdict}
    return _data_set(scene, solution, columns, system)


def _system(eps: Any) -> dict[str, Any]:
    return {"system": "limit"} if eps is None else {"system": "wiggly", "eps": float(eps)}


def _with_turning(
    scene: Scene, effect: NapFlip, solution: Any, support: SupportRows, eps: Any
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Numbers by name, and what is said of all, of a rod that turns over."""
    needs = "that of this scene, with effects.NapFlip"
    require(solution.tip is not None, "solution", "one without root, tip and mode", needs)
    forces = turning_forces(scene, effect, solution, support.force, eps)
    columns = _columns(scene, solution, forces, support)
    if eps is None:
        ends = turning_bounds(scene, effect, support.force, np.asarray(solution.mode))
        columns |= {"tangential_low": ends[0], "tangential_high": ends[1]}
    critical = flipping_rod(scene, effect).critical
    compression = -np.asarray(forces.axial)
    columns |= {
        "mode": solution.mode,
        "compression": compression,
        "buckling_share": compression / critical,
    }
    said = "turns over where the share comes to 1 while the root moves against the nap"
    system = _system(eps) | {"critical_load": critical, "buckling": said}
    straight = np.where(np.asarray(solution.mode) == 0, np.nan, compression)
    reading = axial_reading(scene, straight)
    if reading is not None:
        columns["sprung_share"] = reading.share
        system |= {"sprung_load": reading.critical, "sprung_buckling": reading.verdict}
    return columns, system


def _eps_of(scene: Scene, eps: Any, in_limit: bool) -> Any:
    if in_limit:
        require(eps is None, "eps", eps, "None: a limit solution has none")
        return None
    require(eps is not None, "eps", eps, "the eps in m that the solution was made with")
    require_numbers("eps", eps, "one number eps > 0", lambda e: (e > 0) & (e.ndim == 0))
    eps = jnp.asarray(as_real(eps))
    require_reach(scene.potential, eps)
    return eps


def _columns(
    scene: Scene, solution: Any, forces: TipForces, support: SupportRows
) -> dict[str, Any]:
    """Numbers by name, None where there are none."""
    constant = 0.0 if scene.bristle is None else float(scene.bristle.root_constant())
    rest = scene.load.rest_length if isinstance(scene.load, Pulled) else 0.0
    spring = scene.support if isinstance(scene.support, Spring) else None
    far = None if spring is None else np.asarray(support.load) / float(spring.stiffness)
    z = np.asarray(solution.z)
    return {
        "z": z,
        "u": z - constant,
        "q": None if far is None else far + rest - constant,
        "p": forces.tip,
        "theta": forces.angle,
        "length": forces.length,
        "normal_force": forces.normal,
        "tangential_force": forces.tangential,
        "axial_force": forces.axial,
        "support_force": support.force,
        "energy_support": support.energy,
        "energy_bristle": forces.energy,
        "power": support.power,
    } | ({} if solution.dissipation is None else {"dissipation": solution.dissipation})


def _kinetic(scene: Scene, solution: Solution, eps: Any) -> dict[str, Any]:
    inertia = inertia_among(scene.effects)
    if inertia is None:
        return {}
    velocity, needs = solution.velocity, "that of this scene, with effects.Inertia"
    require(velocity is not None, "solution", "one without velocity", needs)
    return {"energy_kinetic": 0.5 * inertia.mass_at(eps) * np.asarray(velocity) ** 2}


def _bounds(scene: Scene, support: SupportRows) -> dict[str, Any]:
    """What the tangential force of a limit solution could be: on a slide what it is."""
    law = coefficients_jit(scene.potential)
    least, greatest = float(law.rho_minus), float(law.rho_plus)
    force, load = np.asarray(support.force), np.asarray(support.load)
    # l - Phi' loses spacings of l, as in `limit_dissipation`.
    slack = SETTINGS.spacings * np.spacing(np.maximum(np.abs(load), np.abs(load - force)))
    slack += SETTINGS.slack * (greatest - least)
    high = np.where(force <= least + slack, least, greatest)
    low = np.where(force >= greatest - slack, greatest, least)
    return {"tangential_low": -high, "tangential_high": -low}


def _data_set(
    scene: Scene, solution: Any, columns: dict[str, Any], system: dict[str, Any]
) -> Any:
    import xarray as xr  # 0.4 s

    ts, notes = np.asarray(solution.ts), _notes(scene)
    variables = {}
    for name, (unit, meaning) in _UNITS.items():
        if name not in columns:
            continue
        values = columns[name]
        attributes = {"units": unit, "long_name": meaning} | notes.get(name, {})
        if values is None:
            values = np.full(ts.shape, np.nan)
            attributes["missing"] = _why_missing(scene, name)
        variables[name] = ("time", np.asarray(values), attributes)
    ended = {"ok": int(bool(solution.ok)), "message": str(solution.message)}
    time = ("time", ts, {"units": "s"})
    return xr.Dataset(variables, coords={"time": time}, attrs=system | ended)


def _why_missing(scene: Scene, name: str) -> str:
    if name == "q":
        return _NO_SPRING
    return _NO_GEOMETRY if isinstance(scene.potential, BristlePotential) else _NO_BRISTLE


def _notes(scene: Scene) -> dict[str, dict[str, str]]:
    notes = {"sprung_share": {"missing": _BENT}}
    if scene.bristle is None or scene.bristle.geometry(jnp.zeros(())) is None:
        notes["u"] = {"note": _ROOT}
    if not isinstance(scene.load, Pulled):
        notes["q"] = {"note": _UNKNOWN_REST}
    if not isinstance(scene.support, Spring):
        notes["energy_support"] = notes["power"] = {"note": _OTHER_SUPPORT}
        notes.pop("q", None)
    return notes
