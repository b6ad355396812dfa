"""What a command was asked to do: its scene, its surface, its numbers, checked."""

import math
import re
import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from .._checks import require
from ..bristles import AbstractBristle, AngularSpring, SlantedSpring, pulling_note
from ..io import default_numbers, default_study, load_study
from ..measured import Measured, RowCoefficients, fit_profile, heights_of, row_coefficients
from ..model import Scene
from ..profiles import SlopesUndetermined

_FEW_PERIODS = 2.0
_SHELL_ADVICE = (  # what theirs says, for whoever writes no Python
    'Straight flanks with corners are kind = "Polyline" in [profile] of a scene file; '
    "noise asks for smoothing of a stated length: --smoothing LENGTH beside --heights"
)
_ARGUMENTS = re.compile(r"(?<![\w./-])(length_unit|height_unit|height_scale)(?![\w./-])")
_BRISTLES: dict[str, tuple[Any, dict[str, float]]] = {  # as the command line names them
    "slanted": (
        SlantedSpring,
        {"stiffness": 1.0, "rest_length": 2.4, "height": 1.0, "angle": 1.0},
    ),
    "angular": (
        AngularSpring,
        {"stiffness": 1.0, "length": 2**0.5, "height": 1.0, "rest_angle": 0.3},
    ),
}


def named_bristle(name: str) -> AbstractBristle:
    """The bristle that the command line calls by this name."""
    kind, numbers = _BRISTLES[name]
    return kind(**numbers)


class ReportRequest(NamedTuple):
    """`command`: as it was typed; `started`: by `time.perf_counter`; `expected`: its cost
    in words, where somebody knew."""

    command: str
    started: float
    expected: str = ""


class Job(NamedTuple):
    """A scene, its file, and what is known of the measured surface, where there is one.

    `scenes`: one for each row of a map, by its number, where all are asked for. `report`:
    where a page is to be written too. `seed`: of the path of a scene with noise. `own`:
    names of the numbers of the study that the file gives; others are the embedded ones.
    """

    scene: Scene
    study: dict[str, Any]
    notes: list[str]
    rows: RowCoefficients | None
    row: int | None = None
    scenes: dict[int, Scene] | None = None
    report: ReportRequest | None = None
    seed: int | None = None
    own: frozenset[str] = frozenset()

    @property
    def error(self) -> dict[str, float]:
        """Standard errors of the friction of the scene's profile, where they are known."""
        return self.rows.error if self.rows is not None and self.row is None else {}


def read_job(
    path: str | None,
    bristle: str | None = None,
    heights: str | None = None,
    rows: bool = False,
    **surface: Any,
) -> Job:
    """The scene of a file (None: the embedded one), its bristle and surface exchanged.

    `surface`: of a measured surface in `heights` its `period`, `harmonics`, `row` and
    `smoothing`, and options of `read_heights`. `rows`: every row of the map as a scene of
    its own too. What warns of the surface is a note. Raises `ValueError`, one line, for
    whatever is wrong.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", SlopesUndetermined)
        try:
            job = _read_job(path, bristle, heights, **surface)
        except ValueError as error:
            raise ValueError(_with_options(str(error))) from error
    if rows:
        job = _with_rows(job)
    return job._replace(notes=[*map(_with_options, job.notes), *_said_of(caught)])


def _with_options(text: str) -> str:
    """Arguments of `read_heights` as the command line has them."""
    return _ARGUMENTS.sub(lambda found: "--" + found[0].replace("_", "-"), text)


def _with_rows(job: Job) -> Job:
    """With a scene for each row that the bristle admits."""
    many = job.rows is not None and job.row is None
    if not many:
        raise ValueError("--rows: needs --heights FILE with a map, and no --row")
    bristle = job.scene.bristle
    assert job.rows is not None
    assert bristle is not None
    scenes = {
        index: with_surface(job.scene, profile, bristle)
        for index, profile in zip(job.rows.used, job.rows.profiles, strict=True)
    }
    return job._replace(scenes=scenes)


def _said_of(caught: list[warnings.WarningMessage]) -> list[str]:
    """Notes of what warned of the surface; other warnings go on."""
    notes: dict[str, None] = {}
    for warning in caught:
        if issubclass(warning.category, SlopesUndetermined):
            text = str(warning.message).replace(SlopesUndetermined.advice, _SHELL_ADVICE)
            notes[f"Note: {text}"] = None
        else:
            warnings.warn_explicit(
                warning.message, warning.category, warning.filename, warning.lineno
            )
    return list(notes)


def _read_job(
    path: str | None,
    bristle: str | None,
    heights: str | None,
    *,
    period: float | None = None,
    harmonics: int | None = None,
    row: int | None = None,
    smoothing: float | None = None,
    **file: Any,
) -> Job:
    known = default_study() if path is None else load_study(path)
    study = known.study if path is None else {**default_numbers(), **known.study}
    own: frozenset[str] = frozenset() if path is None else frozenset(known.study)
    chosen = known.scene.bristle if bristle is None else named_bristle(bristle)
    needs = "[profile] and [bristle], of which commands are: its scene is Python's"
    require(chosen is not None, f"{path}: [potential]", "given", needs)
    assert chosen is not None
    pulls = pulling_note(chosen)
    warned = [f"Note: {pulls}"] if pulls else []
    if heights is None:
        fit = {"period": period, "harmonics": harmonics, "row": row, "smoothing": smoothing}
        for name, value in {**file, **fit}.items():
            require(value is None, name, value, "--heights FILE beside it")
        scene = known.scene if bristle is None else known.scene.replace(bristle=chosen)
        return Job(scene, study, warned, None, own=own)
    measured = heights_of(heights, **file)
    harmonics = 8 if harmonics is None else harmonics
    try:
        found = fit_profile(measured, period, harmonics, row, smoothing)
        scene = with_surface(known.scene, found.profile, chosen)
        rows = None
        if measured.heights.shape[0] > 1:
            # Of all rows, whichever is chosen: the period of one is known far less well.
            common = found.period if row is None else period
            rows = row_coefficients(measured, chosen, harmonics, common, smoothing)
    except ValueError as error:
        raise ValueError(f"{heights}: {error}") from None
    notes = warned + _notes(heights, measured, found, row)
    return Job(scene, study, notes, rows, row, own=own)


def with_surface(old: Scene, profile: Any, bristle: AbstractBristle) -> Scene:
    """The scene with another surface and bristle."""
    return old.replace(profile=profile, bristle=bristle)


def _notes(path: str, measured: Measured, found: Any, row: int | None) -> list[str]:
    rows, count = measured.heights.shape
    which = "rows moved into phase, their mean" if row is None else f"row {row}"
    size = f"{rows} rows of {count}, {which}" if rows > 1 else f"{count} heights"
    periods = float(np.ptp(measured.x)) / found.period
    hardly = periods < _FEW_PERIODS or found.explained < 0.5
    meaning = "" if hardly else "the surface's real eps, "
    lines = [
        f"{path}: {size}; period {found.period:.4g} m, {meaning}"
        f"explains {found.explained:.0%} of the variance"
    ]
    if found.smoothing is not None:
        lines.append(f"Smoothed by a Gaussian filter of cut-off {found.smoothing:.4g} m")
    if hardly:
        lines.append(
            f"Note: {periods:.2g} periods in a trace, {found.explained:.0%} explained: "
            "the surface is hardly periodic, its friction says little"
        )
    return lines + [f"Note: {path}: {note}" for note in measured.notes]


def number_list(name: str, text: str) -> list[float]:
    """`0.1,0.05` or `START:STOP:N`, N values with equal ratios, both ends included.

    Raises `ValueError` for what is neither.
    """
    allowed = "numbers > 0, as 0.1,0.05,0.02 or START:STOP:N (equal ratios)"
    ranged = text.split(":")
    try:
        if len(ranged) == 3 and re.fullmatch(r"\s*\d+\s*", ranged[2]):
            values = _geometric(float(ranged[0]), float(ranged[1]), int(ranged[2]))
        else:
            values = [float(item) for item in text.split(",")]
    except ValueError:
        values = []
    good = bool(values) and all(math.isfinite(v) and v > 0 for v in values)
    require(good, name, text, allowed)
    return values


def _geometric(start: float, stop: float, count: int) -> list[float]:
    inside = 0 < start < math.inf and 0 < stop < math.inf and 0 < count <= 10_000
    return np.geomspace(start, stop, count).tolist() if inside else []


def joined(sections: Sequence[tuple[str, str]]) -> str:
    """Tables under their titles."""
    return "\n\n".join(f"{title}\n{text}" if title else text for title, text in sections)
