"""The report of a design, as a page."""

import time
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from .._text import ResultTable
from ..coefficients import Coefficients
from ..model import Scene
from .job import Job, ReportRequest
from .page import (
    Captioned,
    Html,
    Page,
    Section,
    items,
    page_text,
    paragraph,
    preformatted,
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
    status_legend,
    words_section,
)


class DesignFacts(NamedTuple):
    """What was designed: `verdict` and `found` of it, a table or lines; `read_back`: the
    friction of the scene as its file has it, None where effects make it another one;
    `check`: on the dynamics, with its statuses.
    """

    job: Job
    scene: Scene
    wanted: Mapping[str, float]
    verdict: str
    found: ResultTable | str
    seed: str
    law: Coefficients
    read_back: Coefficients | None
    coefficients: ResultTable
    check: ResultTable | None
    check_told: str
    statuses: Sequence[int]
    pictures: Mapping[str, Figure]
    files: Sequence[str]
    toml: str


_WORDS = (
    *("rho", "ratio", "alpha", "omega", "eps", "gamma", "state z", "slip", "limit"),
    "accuracy",
)
_ABOUT = (
    "Usually one takes a bristle and a surface and asks what friction they have. Here the "
    "question is asked the other way round: which bristle, or which surface, has the "
    "friction that is wanted."
)
_CAPTIONS = {
    "design": (
        "What bristles give, over the number that can be chosen: the dot is the design "
        "found, the dashed line what was wanted."
    ),
    "surface": (
        "The surface found, and its slopes; other surfaces that would do as well in grey."
    ),
    "map": (
        "Friction over a plane of designs: across the number that is free, up the "
        "asymmetry of the surface. Hatched: no bristle there can follow the surface; "
        "dotted: it would pull."
    ),
}
_FILES = {
    "design.toml": "the scene with the design",
    "heights.csv": "heights of its surface, x_m and height_m, for a machine tool",
    "fit.json": "the result of the search, to be read by the library",
    "tables.txt": "the tables as text",
}


def design_page(facts: DesignFacts, asked: ReportRequest) -> str:
    """The page: the design, what it gives, whether motions show it, how to make it."""
    job, study = facts.job, facts.job.study
    gammas = np.atleast_1d(study["gamma"])
    gamma = float(gammas[np.argmin(np.abs(gammas - 1.0))])
    wanted = ", ".join(f"{name} = {value:.6g}" for name, value in facts.wanted.items())
    origin = Origin(
        asked.command,
        time.perf_counter() - asked.started,
        [("asked for", wanted)],
        facts.seed,
    )
    files = [(name, _FILES.get(name, "a picture of this page")) for name in facts.files]
    again = ["frictionjax friction design.toml", "frictionjax study design.toml --report"]
    return page_text(
        Page(
            title="A design for a wanted friction",
            about=_ABOUT,
            verdict=facts.verdict,
            first=[items(job.notes)] if job.notes else [],
            sections=[
                Section("The design", [*_found(facts), *_pictures(facts)]),
                coefficient_section(facts.law, facts.coefficients),
                _proof(facts),
                *_failures(facts),
                scene_section(facts.scene, facts.law, float(np.min(study["eps"])), gamma),
                origin_section(origin),
                reproduction_section(origin, facts.toml, again, files),
                words_section(_WORDS),
            ],
            made_by=f"Written by frictionjax. {scene_sentence(facts.scene)}",
        )
    )


def _found(facts: DesignFacts) -> list[Html]:
    if isinstance(facts.found, str):
        return [preformatted(facts.found)]
    return [table_region(facts.found, "What the search found")]


def _pictures(facts: DesignFacts) -> list[Html]:
    law = facts.law
    gives = (
        f"The design gives {float(law.rho_plus):.6g} N to the right and "
        f"{float(law.rho_minus):.6g} N to the left."
    )
    captions = dict(_CAPTIONS)
    if set(facts.wanted) == {"rho_plus", "rho_minus"}:
        captions["design"] = captions["surface"]
    return [
        shown(Captioned(figure, f"{facts.verdict} {gives} {captions[n]}", captions[n]), n)
        for n, figure in facts.pictures.items()
    ]


def _proof(facts: DesignFacts) -> Section:
    blocks = [paragraph(_OF_EFFECTS)]
    if facts.read_back is not None:
        table = _read_back_rows(facts.read_back, facts.wanted)
        blocks = [paragraph(_READ_BACK), table_region(table, "Wanted and read back")]
    if facts.check is not None:
        blocks += [
            paragraph(f"{_CHECK} {facts.check_told}"),
            table_region(facts.check, "Steady slides"),
        ]
    return Section("What proves it", blocks)


def _read_back_rows(law: Coefficients, wanted: Mapping[str, float]) -> ResultTable:
    rows = []
    for name, value in wanted.items():
        got = _quantity(law, name)
        rows.append((name, f"{value:.10g}", f"{got:.10g}", f"{got - value:+.1e}"))
    header = ("coefficient", "wanted", "of the file design.toml", "difference")
    return ResultTable(header, tuple(rows), left=1)


_OF_EFFECTS = (
    "What was asked for is the friction of the scene with its effects; the coefficients "
    "above are those of one bristle that stands as it does at first."
)
_READ_BACK = (
    "The file of the design was read again, and friction computed from it alone, which "
    "knows nothing of the search. Forces are in N, ratios without unit."
)
_CHECK = (
    "The friction wanted is that of eps -> 0. A motion at finite eps shows a little more "
    "or less: these are steady slides over the surface, in both directions, their mean and "
    "their largest force, and the gaps to the limit."
)


def _quantity(law: Coefficients, name: str) -> float:
    plus, minus = float(law.rho_plus), float(law.rho_minus)
    known = {"rho_plus": plus, "rho_minus": minus}
    return (known | {"ratio": -plus / minus, "difference": plus + minus})[name]


def _failures(facts: DesignFacts) -> list[Section]:
    if facts.check is None:
        told = "No slide was computed for this scene, and none failed."
        return [Section("What failed", [paragraph(told)])]
    failed = sum(code != 0 for code in facts.statuses)
    told = f"{failed or 'None'} of the {len(facts.statuses)} slides failed."
    legend = status_legend(facts.statuses)
    region = table_region(legend, "What statuses mean", as_csv=False)
    return [Section("What failed", [paragraph(told), region])]
