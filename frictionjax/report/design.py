"""A design from the shell: table, scene, heights for a machine tool, pictures."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from jaxtyping import Float

from .. import plot
from .._checks import as_text, require, write_whole
from .._text import ResultTable
from ..bristles import AbstractBristle
from ..coefficients import Coefficients
from ..design import (
    CHECKED_EPS,
    AngleFit,
    DesignCheck,
    Target,
    check_design,
    design_map,
    fit_angle,
    fit_profile,
    intervals_text,
    surface_heights,
    write_heights,
)
from ..effects import CompliantArray, Engine, NapFlip, does
from ..io import load_scene, scene_document, unit_of
from ..model import (
    Scene,
    friction,
    potential,
    reaches,
    with_effects,
)
from ..profiles import AbstractProfile
from ..supports import Spring
from .design_page import DesignFacts, design_page
from .folder import write_figures
from .job import Job, joined, with_surface

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MAP = 121  # values of an axis
TARGETS = ("ratio", "difference", "rho_plus", "rho_minus")


class DesignRequest(NamedTuple):
    """What a design is to reach: `wanted` of `TARGETS`, and how its results are written."""

    wanted: dict[str, float]
    free: str | None
    bounds: tuple[float, float] | None
    period: float
    samples: int
    harmonics: int
    smallest_radius: float | None = None
    largest_amplitude: float | None = None
    pulling: bool = False


class _Design(NamedTuple):
    """A scene that gives what was asked for, what was found, pictures and further files.

    `told`: what was found as lines, or as a table; `verdict`: in a sentence.
    """

    scene: Scene
    told: ResultTable | str
    verdict: str
    pictures: "Iterator[tuple[str, Figure]]"
    files: dict[str, str]
    seed: str


def run_design(job: Job, folder: Path, asked: DesignRequest) -> str:
    """Design the scene's bristle, or its surface, write it into `folder`, return tables.

    `rho_plus` and `rho_minus` together: the surface (`fit_profile`); one of them, or a
    ratio or difference: one number of the bristle (`fit_angle`); with the scene's effects.
    Slides show it at a few eps of the scene file's study that the bristle reaches.

    Raises `ValueError` for targets that contradict each other or cannot be reached, with
    what can be; nothing is written then.
    """
    wanted = {name: value for name, value in asked.wanted.items() if value is not None}
    both = set(wanted) == {"rho_plus", "rho_minus"}
    if not both and len(wanted) != 1:
        given = [f"--{name.replace('_', '-')}" for name in wanted]
        allowed = "one of --ratio, --difference, --rho-plus, --rho-minus, or the last two"
        raise ValueError(f"{', '.join(given) or 'no target'}: needs {allowed}")
    design = _surface(job, asked, wanted) if both else _bristle(job, asked, wanted)
    scene = design.scene
    profile, _ = _parts(scene)
    surface_heights(profile, asked.period, asked.samples)  # raises, or fits
    sections = [("", line) for line in job.notes]
    sections.append(("Inverse design", _as_lines(design.told)))
    many = any(isinstance(effect, CompliantArray) for effect in scene.effects)
    title = "Friction coefficients of each bristle" if many else "Friction coefficients"
    law = friction(scene)
    coefficients = law.table()
    sections.append((title, str(coefficients)))
    check = None
    slides = all(does(Engine.SLIDE, effect) for effect in scene.effects)
    if isinstance(scene.support, Spring) and slides:
        check = _on_dynamics(job, scene)
        told = _out_of_reach(job) if check is None else repr(check)
        sections.append(("On the dynamics", told))
    text = joined(sections)
    toml = scene_document(scene, job.study)
    write_whole(folder / "design.toml", toml)
    write_whole(folder / "tables.txt", text + "\n")
    write_heights(folder / "heights.csv", profile, asked.period, asked.samples)
    for name, content in design.files.items():
        write_whole(folder / name, content + "\n")
    pictures = dict(design.pictures)
    write_figures(folder, iter(pictures.items()))
    if job.report is not None:
        facts = DesignFacts(
            job,
            scene,
            wanted,
            design.verdict,
            design.told,
            design.seed,
            law,
            _read_back(folder / "design.toml", scene.effects),
            coefficients,
            None if check is None else check.gap_table,
            "" if check is None else repr(check).partition("\n")[0] + ".",
            [] if check is None else [int(one) for one in np.atleast_1d(check.status)],
            pictures,
            sorted(path.name for path in folder.iterdir()),
            toml,
        )
        write_whole(folder / "report.html", design_page(facts, job.report))
    return text


def _on_dynamics(job: Job, scene: Scene) -> DesignCheck | None:
    """Slides at eps of the study that the design's bristle reaches; None where it reaches
    none."""
    profile, bristle = _parts(scene)
    sizes = _eps_of(job)
    sizes = sizes[reaches(with_effects(potential(profile, bristle), scene.effects), sizes)]
    if not sizes.size:
        return None
    # A slide takes seconds: the ends, and what lies between them.
    few = sizes[np.unique([0, (sizes.size - 1) // 2, sizes.size - 1])]
    gamma = float(np.atleast_1d(job.study["gamma"])[0]) if "gamma" in job.own else 1.0
    options: Any = {"support": scene.support, "effects": scene.effects}
    return check_design(profile, bristle, few, gamma, **options)


def _eps_of(job: Job) -> Float[np.ndarray, " n"]:
    """Decreasing, in m: those of the file, if it gives any."""
    given = np.atleast_1d(job.study["eps"]) if "eps" in job.own else np.array(CHECKED_EPS)
    return np.unique(given.astype(float))[::-1]


def _out_of_reach(job: Job) -> str:
    least = f"eps = {as_text(_eps_of(job)[-1])} m"
    given = f"{least}, the smallest in [study]" if "eps" in job.own else least
    return f"No slide: the bristle does not follow the surface, not even at {given}"


def _as_lines(told: ResultTable | str) -> str:
    """Without the names of two columns that say nothing in a shell."""
    if isinstance(told, str):
        return told
    return str(told._replace(header=("", ""))).lstrip("\n")


def _read_back(path: Path, effects: tuple) -> Coefficients | None:
    """Friction of the scene in a file; None where it is not what was asked for: of one
    bristle of an array, of a rod that has not turned over."""
    if any(isinstance(effect, CompliantArray | NapFlip) for effect in effects):
        return None
    return friction(load_scene(path, functions=True))  # written here, of what is there


def _parts(scene: Scene) -> tuple[AbstractProfile, AbstractBristle]:
    assert scene.profile is not None  # scenes of a file have both
    assert scene.bristle is not None
    return scene.profile, scene.bristle


def _bristle(job: Job, asked: DesignRequest, wanted: dict[str, float]) -> _Design:
    profile, bristle = _parts(job.scene)
    for name in ("smallest_radius", "largest_amplitude"):
        value = getattr(asked, name)
        allowed = "--rho-plus and --rho-minus together: the surface is given otherwise"
        require(value is None, name, value, allowed)
    options: Any = wanted | {"free": asked.free or "angle", "bounds": asked.bounds}
    options |= {"pulling": asked.pulling, "effects": job.scene.effects}
    fit = fit_angle(profile, bristle, **options)
    if not fit.success:
        raise ValueError(fit.message)
    found = with_surface(job.scene, profile, fit.bristle)
    pictures = _bristle_pictures(fit)
    number = f"{fit.free} = {float(fit.value):.6g} {_unit(fit.bristle, fit.free)}".rstrip()
    verdict = (
        f"Asked for: {_with_unit(fit.quantity, float(fit.target))}. Found: a "
        f"{type(bristle).__name__} with {number} gives "
        f"{_with_unit(fit.quantity, float(fit.achieved))}."
    )
    if fit.status.message != "found":
        verdict += f" Mind: {fit.status.message}."
    files = {"fit.json": fit.to_json()}
    return _Design(found, angle_rows(fit), verdict, pictures, files, _NO_SEED)


def _unit(bristle: AbstractBristle, name: str) -> str:
    unit = unit_of(bristle, name)
    return "" if unit == "1" else unit


def _with_unit(quantity: str, value: float) -> str:
    return f"{quantity} = {value:.6g}{'' if quantity == 'ratio' else ' N'}"


_NO_SEED = "none: nothing in this search is drawn at random"
_SEED = "0, of the random surfaces that the search starts from, and of those in grey"


def angle_rows(fit: AngleFit) -> ResultTable:
    """What one `fit_angle` found: value, reach, other solutions, sensitivities."""
    moved = fit.sensitivities
    unit, of = _unit(fit.bristle, fit.free), "" if fit.quantity == "ratio" else " N"
    per = f"{unit or '1'}/N" if of else unit
    others = [as_text(v) for v in np.asarray(fit.solutions) if v != float(fit.value)]
    rows = [
        ("wanted", f"{fit.quantity} = {as_text(fit.target)}{of}"),
        ("achieved", f"{float(fit.achieved):.10g}{of}"),
        ("alpha", f"{float(fit.alpha):.10g} N"),
        (fit.free, f"{float(fit.value):.10g} {unit}".rstrip()),
        ("other solutions", ", ".join(others) or "none"),
        ("reachable", f"{fit.quantity} in {intervals_text(fit.reachable)}{of}"),
        (f"d {fit.free}/d {fit.quantity}", f"{as_text(moved.target)} {per}".rstrip()),
        (f"d {fit.free}/d omega_plus", f"{as_text(moved.omega_plus)} {unit}".rstrip()),
        (f"d {fit.free}/d omega_minus", f"{as_text(moved.omega_minus)} {unit}".rstrip()),
        ("status", fit.status.message),
    ]
    return ResultTable(("number", "value"), tuple(rows), left=2)


def _bristle_pictures(fit: AngleFit) -> "Iterator[tuple[str, Figure]]":
    yield "design", plot.draw_angle_fit(fit)
    if fit.effects:  # the map is of one bristle, as it is
        return
    numbers = np.asarray(fit.admissible)
    numbers = numbers[~np.isnan(numbers[:, 0])]
    across = np.linspace(numbers.min(), numbers.max(), _MAP)
    steepness = 0.5 * float(fit.slopes.plus - fit.slopes.minus)
    axes: Any = (fit.free, across), "asymmetry"
    data = design_map(fit.bristle, *axes, steepness=steepness, pulling=fit.pulling)
    yield "map", plot.draw_design_map(data)


def _surface(job: Job, asked: DesignRequest, wanted: dict[str, float]) -> _Design:
    _, bristle = _parts(job.scene)
    target = Target(bristle, wanted["rho_plus"], wanted["rho_minus"])
    free = [asked.free] if asked.free else []
    require(free or asked.bounds is None, "bounds", asked.bounds, "--free as well")
    given = not free or asked.bounds is not None
    require(given, "bounds", None, "--bounds LOW HIGH as well as --free")
    fit = fit_profile(
        target,
        harmonics=asked.harmonics,
        free=free,
        bounds=dict.fromkeys(free, asked.bounds),
        smallest_radius=asked.smallest_radius,
        largest_amplitude=asked.largest_amplitude,
        pulling=asked.pulling,
        effects=job.scene.effects,
    )
    if not fit.success:
        raise ValueError(fit.message)
    found = with_surface(job.scene, fit.profile, fit.bristles[0] or bristle)
    pictures = iter([("design", plot.draw_profile_fit(fit))])
    verdict = (
        f"Asked for: rho_plus = {target.rho_plus:.6g} N and rho_minus = "
        f"{target.rho_minus:.6g} N. A surface of {asked.harmonics} harmonics was designed "
        f"for it: {fit.status.message}; the largest error is {fit.largest_error:.1e}."
    )
    files = {"fit.json": fit.to_json()}
    return _Design(found, repr(fit), verdict, pictures, files, _SEED)
