"""What a study has found: orders, tables, pictures, files."""

from pathlib import Path
from textwrap import fill

import xarray as xr

from .._checks import write_whole
from ..coefficients import coefficient_table
from ..io import scene_document
from ..model import friction
from ..studies import (
    failed_table,
    lemma_table,
    order_table,
    spread_table,
    study,
    sweep_table,
)
from .folder import study_figures, write_study
from .job import Job, joined
from .sections import friction_of_slides
from .study_page import StudyFacts, study_page
from .study_words import verdict_sentence
from .tables import row_table

_COVERS = (
    "Intervals are for eps -> 0. With a law: of the ratio of the errors to those that the\n"
    "law has at each eps, added to its order. averaged: wells are passed without a rest;\n"
    "slips: tips rest before each; between: at the threshold. free: of a power, with\n"
    "scatter, corrections 1 + c eps^q, q >= 0.2 (up to 5% where scatter hides them), and\n"
    "logarithms that the errors show; slower or larger hidden ones are not in them.\n"
    "Constants are those of eps^order for eps -> 0, jointly with the order. seen: slope\n"
    "of the errors in the window, all that they show alone. not yet seen: errors follow\n"
    "the law, not yet its power; order and constant are theory's, confirmed through it."
)

_CELLS = (
    "sup error: how far the state is from that of dry friction at most, in m and in eps;\n"
    "dissipation error: of the energy that has become heat. residual: of the balance of\n"
    "energies, which closes for solutions alone. steps: of the integrator."
)
_WIDE = 86  # letters of a line of text


def write_results(
    job: Job, data: xr.Dataset, folder: Path, seconds: float, progress: bool = False
) -> str:
    """Write the results of a job's sweep into `folder`, return its tables.

    `seconds`: that the sweep took. `progress`: as of `study`.
    """
    scene = job.scene
    law, slides = friction(scene), friction_of_slides(scene)
    found = study(data, progress=progress)
    sections = [("", line) for line in job.notes]
    if "left_out" in data.attrs:
        sections.append(("", f"Effects left out: {data.attrs['left_out']}"))
    sections.append(("What came out", fill(verdict_sentence(found, slides), _WIDE)))
    coefficients = coefficient_table(law, job.error)
    sections.append(("Friction coefficients", str(coefficients)))
    if job.rows is not None:
        sections.append(("Friction over the rows of the map", row_table(job.rows, job.row)))
    if found.spread is not None:
        sections.append(
            ("Orders over the rows of the map", str(spread_table(found.spread)))
        )
    else:
        sections += [
            ("Cells", f"{sweep_table(data)}\n{_CELLS}"),
            ("Orders of convergence", f"{order_table(found.orders)}\n{_COVERS}"),
            ("Lemmas 7 to 9", str(lemma_table(found.orders))),
        ]
    titles = {"inertia": "Inertia", "noise": "Noise", "turning": "Turning over"}
    told = found.orders.attrs
    sections += [(title, told[name]) for name, title in titles.items() if name in told]
    sections.append(("Failed cells", failed_table(found.failed)))
    text = joined(sections)
    toml = scene_document(scene, job.study)
    pictures = dict(study_figures(found, scene, slides))
    write_study(folder, found, pictures, toml, text)
    if job.report is not None:
        facts = StudyFacts(job, law, slides, found, coefficients, pictures, toml, seconds)
        write_whole(folder / "report.html", study_page(facts, job.report))
    return text
