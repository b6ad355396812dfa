"""The report of a study, as a page."""

import time
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from .. import plot
from .._text import ResultTable
from ..coefficients import Coefficients
from ..studies import (
    Study,
    failures,
    flag_names,
    lemma_table,
    order_table,
    spread_table,
    sweep_table,
)
from .job import Job, ReportRequest
from .page import (
    Captioned,
    Html,
    Page,
    Section,
    definitions,
    items,
    page_text,
    paragraph,
    preformatted,
    shown,
    table_region,
)
from .sections import (
    Origin,
    certificate_rows,
    coefficient_section,
    origin_section,
    reproduction_section,
    scene_section,
    scene_sentence,
    status_legend,
    verdict_legend,
    words_section,
)
from .study_words import picture_of, verdict_sentence
from .tables import row_table


class StudyFacts(NamedTuple):
    """What a study has found, and how: `seconds` of its sweep, `pictures` by file name.

    `law`: of the table `coefficients`, `slides`: of the scene's slides.
    """

    job: Job
    law: Coefficients
    slides: Coefficients
    found: Study
    coefficients: ResultTable
    pictures: Mapping[str, Figure]
    toml: str
    seconds: float

    @property
    def data(self) -> xr.Dataset:
        """The data set of the sweep."""
        return self.found.dataset


_WORDS = (
    *("eps", "gamma", "state z", "limit", "order", "strip", "rho", "alpha", "ratio"),
    *("omega", "dissipation", "cell", "slip", "bracket", "slip map", "residual"),
    "accuracy",
)
_ABOUT = (
    "Dry friction does not depend on the speed; viscosity does. Yet a bristle that moves "
    "through a viscous medium over a surface with ever smaller bumps ends up with dry "
    "friction, and more of it in one direction than in the other. This report follows such "
    "a bristle for smaller and smaller bumps, a distance eps apart, and measures how fast "
    "its motion comes to that of dry friction."
)
_SOLVERS = (
    "Another solver than the library's own has made these values: nothing bounds them. "
    "Compare with a run of `--method auto`."
)


def study_page(facts: StudyFacts, asked: ReportRequest) -> str:
    """The page: what came out, the scene, friction, motion, orders, cells, proofs."""
    job, found = facts.job, facts.found
    eps, gamma = float(np.min(facts.data.eps)), _shown_gamma(facts.data)
    origin = _origin(facts, asked)
    notes = [*job.notes]
    if "left_out" in facts.data.attrs:
        notes.append(f"Effects left out: {facts.data.attrs['left_out']}")
    sections = [
        scene_section(job.scene, facts.law, eps, gamma),
        _friction(facts),
        *_motion(facts),
        _orders(facts),
        *_cells(facts),
        _failures(facts),
        _cost(facts, asked),
        origin_section(origin),
        reproduction_section(origin, facts.toml, _again(facts), _files(facts), _PYTHON),
        words_section(_WORDS),
    ]
    return page_text(
        Page(
            title="From viscosity to dry friction: a convergence study",
            about=_ABOUT,
            verdict=verdict_sentence(found, facts.slides),
            first=[items(notes)] if notes else [],
            sections=[one for one in sections if one.blocks],
            made_by=f"Written by {facts.data.attrs.get('source', 'frictionjax')}. "
            f"{scene_sentence(job.scene)}",
        )
    )


def _again(facts: StudyFacts) -> list[str]:
    """The command with the scene file; of all rows of a map it holds the mean alone."""
    if facts.found.spread is not None:
        return []
    method = str(facts.data.attrs.get("method", "auto"))
    option = "" if method == "auto" else f" --method {method}"
    if facts.job.seed is not None:
        option += f" --seed {facts.job.seed}"
    return [f"frictionjax study scene.toml{option} --out again --report"]


_PYTHON = """\
import frictionjax as fx
import xarray as xr

data = xr.load_dataset("study.nc", engine="h5netcdf")
fx.study(data)  # the orders, and .plot()"""
_FILES = {
    "study.nc": "every number of the study (NetCDF), with units and how it was obtained",
    "orders.nc": "orders, constants and their intervals",
    "spread.nc": "how orders spread over the rows of the map",
    "scene.toml": "the scene",
    "tables.txt": "the tables as text",
}


def _files(facts: StudyFacts) -> list[tuple[str, str]]:
    names = dict(_FILES)
    if facts.found.spread is None:
        names.pop("spread.nc")
    names |= {f"{name}.png": "a picture of this page" for name in facts.pictures}
    return list(names.items())


def _shown_gamma(data: xr.Dataset) -> float:
    """The gamma that pictures of motions show."""
    known = data.gamma.values
    return float(known[np.argmin(np.abs(known - 1.0))])


def _origin(facts: StudyFacts, asked: ReportRequest) -> Origin:
    data = facts.data
    told = [
        ("accuracy", f"{float(data.attrs.get('accuracy', np.nan)):.3g} eps, of z"),
        ("method", str(data.attrs.get("method", "unknown"))),
        ("eps", f"{data.eps.size} values, {_range(data.eps.values)} m"),
        ("gamma", ", ".join(f"{v:.4g}" for v in data.gamma.values)),
        ("times kept", f"{data.time.size}, 0 to {float(data.time[-1]):.4g} s"),
    ]
    passed = time.perf_counter() - asked.started
    if "path_key" in data:
        key = "the variable path_key of study.nc has the key of every cell's path"
        return Origin(asked.command, passed, told, key)
    return Origin(asked.command, passed, told)


def _range(values: np.ndarray) -> str:
    return f"{values.max():.4g} to {values.min():.4g}"


def _friction(facts: StudyFacts) -> Section:
    section = coefficient_section(facts.slides, facts.coefficients)
    if facts.job.rows is None:
        return section
    table = row_table(facts.job.rows, facts.job.row)
    rows = [paragraph("Over the rows of the map:"), preformatted(table)]
    return section._replace(blocks=[*section.blocks, *rows])


def _motion(facts: StudyFacts) -> list[Section]:
    names = ("trajectories", "loop", "dissipation", "turning", "nap_loops")
    drawn = [n for n in names if n in facts.pictures]
    blocks = [_picture(facts, name, facts.pictures[name]) for name in drawn]
    return [Section("The motion", blocks)] if blocks else []


def _picture(facts: StudyFacts, name: str, figure: Figure) -> Html:
    told, caption = picture_of(
        name, facts.found, facts.slides, _shown_gamma(facts.data), len(figure.axes)
    )
    return shown(Captioned(figure, told, caption), name.replace("_", " "))


_ERRORS = ("sup_error", "dissipation_error", "strip_excess")


def _orders(facts: StudyFacts) -> Section:
    found = facts.found
    if found.spread is not None:
        blocks = [
            paragraph(_SPREAD),
            _picture(facts, "convergence", facts.pictures["convergence"]),
            table_region(spread_table(found.spread), "Orders over the rows of the map"),
        ]
        return Section("How fast it converges", blocks)
    blocks = [paragraph(_ORDERS)]
    if "graph_error" in facts.data:
        blocks.append(_picture(facts, "convergence", facts.pictures["convergence"]))
    else:
        blocks += [_picture(facts, name, _panel(facts, name)) for name in _panels(facts)]
    blocks += [
        table_region(order_table(found.orders), "Orders of convergence"),
        paragraph(_LAWS),
        table_region(verdict_legend(), "What the verdicts mean", as_csv=False),
        paragraph(_LEMMAS),
        table_region(lemma_table(found.orders), "Lemmas 7 to 9"),
    ]
    known = [n for n in ("inertia", "turning", "noise") if n in found.orders.attrs]
    blocks += [paragraph(str(found.orders.attrs[name])) for name in known]
    return Section("How fast it converges", blocks)


_ORDERS = (
    "Each point is one computation: across, the distance of the bumps; up, the largest "
    "difference from dry friction at any time. On these scales a power eps^order is a "
    "straight line, and its slope is the order."
)
_SPREAD = (
    "Every row of the measured map was studied as a surface of its own. The table has the "
    "median over the rows, and between which values 90% of them lie."
)
_LAWS = (
    "Intervals are for eps -> 0. Where the errors follow a law of theory, the order is "
    "that law's, corrected by what the errors differ from it: law `slips` where the tip "
    "rests before each slip, `averaged` where it never rests, `between` at the threshold, "
    "`free` where no law holds and a power is fitted. `seen` is the slope of the errors "
    "alone, and `constant` the error over eps^order."
)
_LEMMAS = (
    "The paper behind this library proves bounds with the exponent beta = min(1, gamma); "
    "these are the smallest constants for which its Lemmas 7 and 9 hold in these cells."
)


def _panels(facts: StudyFacts) -> list[str]:
    return [name for name in _ERRORS if name in facts.data]


def _panel(facts: StudyFacts, name: str) -> Figure:
    """Errors of one kind alone: a page may be narrow."""
    others = [other for other in _panels(facts) if other != name]
    data = facts.data.drop_vars(others)
    return plot.draw_convergence(data, facts.found.orders, facts.found.curves)


def _cells(facts: StudyFacts) -> list[Section]:
    if facts.found.spread is not None:
        return [Section(_PROOFS_OF, [paragraph(_worst_sentence(facts.data))])]
    cells = Section(
        "Every computation",
        [paragraph(_CELLS), table_region(sweep_table(facts.data), "Cells")],
    )
    proofs = certificate_rows(facts.data)
    blocks = (
        [paragraph(_SOLVERS)]
        if proofs is None
        else [paragraph(_PROOFS), table_region(proofs, "Certificates")]
    )
    return [cells, Section(_PROOFS_OF, blocks)]


def _worst_sentence(data: xr.Dataset) -> str:
    """Of all rows of a map together, whose cells nobody would read one by one."""
    told = [f"{data.status.size} computations are in `study.nc`, one by one, each with how"]
    told.append("its values were obtained.")
    if "residual" in data and "dissipation" in data:
        share = data.residual / data.dissipation.isel(time=-1)
        worst = float(np.nanmax(np.where(data.status == 0, share, np.nan)))
        told.append(
            f"The energy balance of the worst that did not fail closes to {worst:.1e} of "
            "the energy dissipated."
        )
    if "bracket" in data and bool((data.how == 1).any()):
        widest = float(np.nanmax(data.bracket.where(data.how == 1)))
        told.append(f"The widest bracket used is {widest:.1e} eps wide.")
    return " ".join(told)


_CELLS = (
    "One line for each eps and gamma. The largest error of the state is in m and in units "
    "of eps, that of the dissipated energy in J; steps are those of the integrator."
)
_PROOFS_OF = "What proves the numbers"
_PROOFS = (
    "Computations that follow every slip from the start are checked by their energy "
    "balance. Where there are too many slips, states are proven by brackets: one "
    "computation from provably below and one from provably above, which cannot cross; the "
    "widest bracket says how near they have come. `from every slip`, `by brackets` and `by "
    "slip map` count the times kept by how the state there was found; `sampled` is the "
    "share of the way whose energies and largest distances are known from some of its "
    "slips. The residual says by how much the energy balance of the whole motion fails to "
    "close, in J and as a share of the energy dissipated. A status other than `ok` means "
    "that the numbers of its line cannot be trusted."
)


def _failures(facts: StudyFacts) -> Section:
    failed, codes = facts.found.failed, facts.data.status.values.ravel().tolist()
    told = f"No cell failed, of {len(codes)}."
    if failed:
        told = (
            f"{len(failed)} of {len(codes)} cells failed, and are left out of the orders."
        )
    blocks = [paragraph(told)]
    if failed:
        blocks.append(table_region(failures(failed), "Failed cells"))
    legend = table_region(status_legend(codes), "What statuses mean", as_csv=False)
    return Section("What failed", [*blocks, legend])


def _cost(facts: StudyFacts, asked: ReportRequest) -> Section:
    data, names = facts.data, flag_names(facts.data.status)
    steps = int(np.sum(data.steps.values))
    good = int(np.sum(data.status.values == 0))
    entries = [
        ("expected", asked.expected or "nothing was said beforehand"),
        ("taken", f"{facts.seconds:.3g} s, compilation in it where there was any"),
        ("cells", f"{data.status.size}, of which {good} {names[0]}"),
        ("steps of the integrator", f"{steps:,}".replace(",", " ")),
    ]
    if "rejected" in data:
        share = float(np.sum(data.rejected.values)) / max(steps, 1)
        entries.append(("steps rejected", f"{share:.1%}"))
    return Section("What it cost", [definitions(entries)])
