"""The friction of a scene, as text and as numbers."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .._checks import require, write_whole
from ..bristles import AngularSpring
from ..coefficients import (
    coefficient_table,
    coefficients_by_name,
    condition_of,
    errors_by_name,
)
from ..contact import Nap, nap
from ..effects import NapFlip, nap_flip_among
from ..io import scene_document
from ..limit import solve_limit
from ..model import Scene, friction
from ..profiles import AbstractProfile
from .job import Job, joined
from .sections import friction_of_slides, friction_sentence
from .tables import row_table

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

_TIMES = 2001  # pictures follow a rod that turns over


def friction_text(job: Job) -> str:
    """Notes of a job and tables of its friction coefficients."""
    sections = [("", line) for line in job.notes]
    table = str(coefficient_table(friction(job.scene), job.error))
    sections.append(("Friction coefficients", table))
    if nap_flip_among(job.scene.effects) is not None and _nap_of(job, None).turns_over:
        slides = friction_sentence(friction_of_slides(job.scene))
        sections.append(("Of the rod that turns over", slides))
    if job.rows is not None:
        sections.append(("Over the rows of the map", row_table(job.rows, job.row)))
    return joined(sections)


def friction_document(job: Job) -> dict[str, Any]:
    """The same as JSON has it: null where an error is not finite."""
    law = friction(job.scene)
    numbers: dict[str, Any] = coefficients_by_name(law)
    if law.alpha is not None:
        numbers["pulling"] = bool(law.alpha < 0)
    error = errors_by_name(law, job.error)
    condition = condition_of(law)
    if condition is not None:
        numbers["condition"] = condition.words
    if job.rows is not None or error:
        finite = {name: e if math.isfinite(e) else None for name, e in error.items()}
        numbers["error"] = finite
    if job.rows is not None:
        numbers["rows"] = {"mean": job.rows.mean, "std": job.rows.std}
    if job.notes:
        numbers["notes"] = job.notes
    return numbers


def nap_text(job: Job, bending_stiffness: float | None) -> str:
    """Notes of a job, and friction with and against the nap of its bristle."""
    sections = [("", line) for line in [*job.notes, *_left_out(job)]]
    sections.append(("With and against the nap", repr(_nap_of(job, bending_stiffness))))
    return joined(sections)


def nap_document(job: Job, bending_stiffness: float | None) -> dict[str, Any]:
    """The same as JSON has it: null for what the bristle does not have."""
    found = _nap_of(job, bending_stiffness)
    forces = {
        name: _finite(getattr(found, name))
        for name in (
            "rho_with",
            "rho_against",
            "rho_flipped",
            "ratio",
            "axial_with",
            "axial_against",
            "axial_flipped",
            "critical_load",
        )
    }
    window = None if found.window is None else found.window._asdict()
    told = {**forces, "window": window, "message": found.message}
    notes = _left_out(job)
    return told | ({"notes": notes} if notes else {})


def _left_out(job: Job) -> list[str]:
    """A note on effects of the scene that a nap, of one bristle in the limit, has not."""
    kinds = [type(effect).__name__ for effect in job.scene.effects]
    names = [name for name in kinds if name not in ("NapFlip", "AxialLoad")]
    if not names:
        return []
    return [f"Note: of one bristle, in the limit: without the scene's {', '.join(names)}"]


def nap_figures(job: Job, bending_stiffness: float | None, folder: Path) -> str:
    """Pictures of a rod on an angular spring into a folder; their names, a line each.

    Of one that turns over under the load of the scene also how it does, and the loops of
    both effects, all in the limit. With a report where one is asked for, which other
    bristles have too, without these pictures: then a line says why.
    """
    from .folder import write_figures

    pictures: dict[str, Figure] = {}
    notes = no_nap_pictures(job)
    if not notes:
        pictures, notes = _nap_pictures(job, bending_stiffness)
    names = [path.name for path in write_figures(folder, iter(pictures.items()))]
    if job.report is not None:
        names += _write_report(job, bending_stiffness, pictures, folder)
    return "\n".join(names + notes)


def no_nap_pictures(job: Job) -> list[str]:
    """Why a bristle has none of these pictures, in a line; nothing where it has."""
    bristle = job.scene.bristle
    if isinstance(bristle, AngularSpring):
        return []
    kind = type(bristle).__name__
    return [
        f"No nap.png: that is of rods on an angular spring (--bristle angular), not {kind}"
    ]


def _write_report(
    job: Job, asked: float | None, pictures: "Mapping[str, Figure]", folder: Path
) -> list[str]:
    """Write the report and the scene; their names."""
    from .nap_page import NapFacts, nap_page  # draws, and tables need not

    assert job.report is not None
    toml = scene_document(job.scene, job.study)
    scene, stiffness = turning_scene(job, asked), _stiffness(job, asked)
    laws = friction(scene), friction_of_slides(scene)
    table = coefficient_table(laws[0], job.error)
    facts = NapFacts(job, _nap_of(job, asked), stiffness, *laws, table, pictures, toml)
    write_whole(folder / "scene.toml", toml)
    write_whole(folder / "report.html", nap_page(facts, job.report))
    return ["scene.toml", "report.html"]


def _nap_pictures(job: Job, asked: float | None) -> "tuple[dict[str, Figure], list[str]]":
    """By file name; and notes on what there is none of."""
    from .. import plot

    stiffness = _stiffness(job, asked)
    bristle: Any = job.scene.bristle
    own = plot.draw_own_nap(_profile_of(job), bristle, stiffness)
    pictures = {"nap": own}
    notes = []
    scene = turning_scene(job, stiffness)
    if nap_flip_among(scene.effects) is not None:
        ts = np.linspace(0.0, float(scene.duration), _TIMES)
        limit = solve_limit(scene, ts)
        if np.any(np.asarray(limit.mode) != 1):
            pictures["turning"] = plot.draw_turning(scene, limit)
            pictures["nap_loops"] = plot.draw_nap_loops(scene, ts)
        else:
            notes.append("under the load of the scene the rod does not turn over")
    return pictures, notes


def _profile_of(job: Job) -> AbstractProfile:
    """`job` always has one."""
    assert job.scene.profile is not None
    return job.scene.profile


def turning_scene(job: Job, bending_stiffness: float | None) -> Scene:
    """The scene of a job with its rod as flexible as asked for, else as in the scene.

    A rod that turns over does so, and that alone; a stiffer one keeps its nap.
    """
    stiffness = _stiffness(job, bending_stiffness)
    if stiffness is None:
        return job.scene
    if not _nap_of(job, stiffness).turns_over:
        return job.scene.replace(effects=())
    effect = NapFlip(np.asarray(stiffness))  # type: ignore[arg-type]
    return job.scene.replace(effects=(effect,))


def _stiffness(job: Job, asked: float | None) -> float | None:
    """The bending stiffness asked for, else that of the scene, where it has one."""
    effect = nap_flip_among(job.scene.effects)
    bristle = job.scene.bristle
    rod = asked is None or isinstance(bristle, AngularSpring)
    needs = f"a rod on an angular spring (--bristle angular), not {type(bristle).__name__}"
    require(rod, "--bending-stiffness", asked, needs)
    if asked is not None or effect is None:
        return asked
    return float(effect.bending_stiffness)


def _nap_of(job: Job, bending_stiffness: float | None) -> Nap:
    """Of the scene's parts; `job` always has a bristle."""
    bristle = job.scene.bristle
    assert bristle is not None
    return nap(_profile_of(job), bristle, _stiffness(job, bending_stiffness))


def _finite(number: float | None) -> float | None:
    return None if number is None or not math.isfinite(number) else number
