"""The report of friction with and against the nap, as a page."""

import time
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from .._text import ResultTable
from ..coefficients import Coefficients
from ..contact import Nap
from .job import Job, ReportRequest
from .page import (
    Captioned,
    Page,
    Section,
    items,
    page_text,
    paragraph,
    shown,
    table_region,
)
from .sections import (
    Origin,
    coefficient_section,
    origin_section,
    reproduction_section,
    scene_section,
    scene_sentence,
    words_section,
)


class NapFacts(NamedTuple):
    """What was found of a bristle; `stiffness` of its rod in N m^2, where it has one.

    `law`: of the table `coefficients`, `slides`: of the bristle's slides, which may turn
    it over.
    """

    job: Job
    found: Nap
    stiffness: float | None
    law: Coefficients
    slides: Coefficients
    coefficients: ResultTable
    pictures: Mapping[str, Figure]
    toml: str


_WORDS = (
    *(
        "nap",
        "rho",
        "rho_with",
        "critical load",
        "eps",
        "gamma",
        "state z",
        "slip",
        "alpha",
        "ratio",
    ),
    "omega",
)
_ABOUT = (
    "Bristles lean, as fur does: with the nap they are stroked, against it they bristle "
    "up. This report says what dry friction a bristle has in both directions, and whether, "
    "pushed against its nap, it turns over and leans the other way from then on."
)
_SAYS = {
    "nap": (
        "Left: friction of rods of the same root height over the angle at which they "
        "stand; the dot is this one. Right: the force that compresses them, shaded where a "
        "critical load turns a rod over against the nap and only then."
    ),
    "turning": "How the rod turns over under the load of the scene, in the limit.",
    "nap_loops": (
        "Force against place under the load of the scene: of the bristle that stays as it "
        "stands, and of the one that turns over."
    ),
}
_ALL_FORMULAS = (
    "Nothing here is stepped through time but the pictures of a rod that turns over: the "
    "numbers are formulas of the paper's limit eps -> 0, of the largest and the smallest "
    "slope that the bristle sees. What they need, that the bristle can follow the surface "
    "without a jump, was checked before, and no check failed. How near a motion at finite "
    "eps comes to them is what `frictionjax study` measures."
)
_NO_PICTURE = (
    "The picture over all angles is for rods on an angular spring: this bristle is none."
)


def nap_page(facts: NapFacts, asked: ReportRequest) -> str:
    """The page: both directions, pictures, the scene, where numbers come from."""
    job, found = facts.job, facts.found
    seconds = time.perf_counter() - asked.started
    told = [("bending stiffness", _stiffness_text(facts.stiffness))]
    origin = Origin(asked.command, seconds, told)
    eps, gammas = float(np.min(job.study["eps"])), np.atleast_1d(job.study["gamma"])
    gamma = float(gammas[np.argmin(np.abs(gammas - 1.0))])
    option = "" if facts.stiffness is None else f" --bending-stiffness {facts.stiffness:g}"
    again = f"frictionjax nap scene.toml{option} --out again --report"
    return page_text(
        Page(
            title="With and against the nap",
            about=_ABOUT,
            verdict=verdict_of_nap(found),
            first=[items(job.notes)] if job.notes else [],
            sections=[
                _directions(facts),
                _pictures(facts),
                scene_section(job.scene, facts.law, eps, gamma),
                coefficient_section(facts.slides, facts.coefficients),
                Section("What proves it, and what failed", [paragraph(_ALL_FORMULAS)]),
                origin_section(origin),
                reproduction_section(origin, facts.toml, [again], _files(facts)),
                words_section(_WORDS),
            ],
            made_by=f"Written by frictionjax. {scene_sentence(job.scene)}",
        )
    )


def verdict_of_nap(found: Nap) -> str:
    """Friction both ways, and what becomes of the bristle."""
    forth, back = found.ways
    told = (
        f"Moved {forth} the bristle holds against {found.rho_with:.4g} N, {back} "
        f"{found.rho_against:.4g} N: {found.ratio:.4g} times as much."
    )
    if found.turns_over:
        told += (
            " But it does not stay as it stands: pushed against its nap it turns over, and "
            f"then holds against {found.rho_flipped:.4g} N: "
            f"{found.rho_flipped / found.rho_with:.4g} times as much as with it."
        )
    return f"{told} In detail: {found.message}." if found.message else told


def _stiffness_text(stiffness: float | None) -> str:
    return "not given" if stiffness is None else f"{stiffness:.6g} N m^2"


def _directions(facts: NapFacts) -> Section:
    table = facts.found.table()._replace(note="")
    return Section(
        "Both directions", [paragraph(_DIRECTIONS), table_region(table, "Friction and nap")]
    )


_DIRECTIONS = (
    "Friction is positive here, in N, whatever the direction; the axial force acts along "
    "the bristle, and is negative where it is compressed. `turned over`: moved as before "
    "against the nap, once the bristle leans the other way."
)


def _pictures(facts: NapFacts) -> Section:
    blocks = [
        shown(
            Captioned(figure, _told(name, facts.found), _SAYS[name]), name.replace("_", " ")
        )
        for name, figure in facts.pictures.items()
    ]
    return Section("Pictures", blocks or [paragraph(_NO_PICTURE)])


def _told(name: str, found: Nap) -> str:
    known = [
        ("with the nap", found.rho_with, found.axial_with),
        ("against it", found.rho_against, found.axial_against),
        ("turned over", found.rho_flipped, found.axial_flipped),
    ]
    parts = [
        f"{way}: friction {rho:.4g} N, axial force {axial:.4g} N"
        for way, rho, axial in known
        if np.isfinite(rho)
    ]
    load = found.critical_load
    last = "" if load is None else f" Its critical load is {load:.4g} N."
    return f"{_SAYS[name]} This bristle, {'; '.join(parts)}.{last}"


def _files(facts: NapFacts) -> list[tuple[str, str]]:
    pictures = [(f"{name}.png", "a picture of this page") for name in facts.pictures]
    return [("scene.toml", "the scene"), *pictures]
