"""One attempt at some cells of a sweep, and what is known after several."""

from typing import Any, NamedTuple

import numpy as np

from .._compile import WORKERS
from ..model import TabulatedScene
from ..numerics import concatenated, rows_of
from .enclosure import SETTINGS as ENCLOSURE_SETTINGS
from .enclosure import (
    BracketContext,
    CellBounds,
    Report,
    Requirements,
    close_brackets,
    lay_out,
    no_effort,
)
from .equation import Status
from .lanes import LaneCells, LaneScene
from .limit_path import Path
from .rosenbrock import Tableau
from .sums import CellResults, Sums, evaluate


class Cellwise(NamedTuple):
    """What an attempt needs of each cell."""

    eps: np.ndarray
    ground: CellBounds
    cells: LaneCells
    brief: np.ndarray
    needs: Requirements


def _with_rows(column: np.ndarray, chosen: np.ndarray, rows: Any) -> np.ndarray:
    """The column with other values in the rows `chosen`."""
    changed = column.copy()
    changed[chosen] = rows
    return changed


class SoFar(NamedTuple):
    """Cells with all that is known of them, their answers, and which brackets stay open.

    `open_` (cells,): whether a bracket of the cell does.
    """

    cells: Cellwise
    answers: CellResults
    open_: np.ndarray

    def with_status(self, chosen: np.ndarray, status: Status) -> "SoFar":
        """Some cells with another status."""
        changed = _with_rows(self.answers.status, chosen, int(status))
        return self._replace(answers=self.answers._replace(status=changed))

    def with_attempt(self, part: "SoFar", chosen: np.ndarray) -> "SoFar":
        """The answers of another attempt; its steps are on top of those before."""
        whole, new = self.answers, part.answers
        columns = {
            name: _with_rows(column, chosen, getattr(new, name))
            for name, column in whole._asdict().items()
        }
        columns |= {
            "steps": _with_rows(whole.steps, chosen, new.steps + whole.steps[chosen]),
            "rejected": _with_rows(
                whole.rejected, chosen, new.rejected + whole.rejected[chosen]
            ),
            "tolerance": whole.tolerance,
        }
        open_ = _with_rows(self.open_, chosen, part.open_)
        return self._replace(answers=CellResults(**columns), open_=open_)

    def with_cells(self, some: Cellwise, chosen: np.ndarray) -> "SoFar":
        """Other needs of some cells, for later attempts too."""
        needs = Requirements._make(
            _with_rows(old, chosen, new)
            for old, new in zip(self.cells.needs, some.needs, strict=True)
        )
        return self._replace(cells=self.cells._replace(needs=needs))


class AttemptContext(NamedTuple):
    """What all attempts share."""

    scene: TabulatedScene
    path: Path
    lanes: LaneScene
    tableau: Tableau
    ts: np.ndarray
    accuracy: float
    wanted: Sums
    every_slip: bool
    report: Report
    workers: int = WORKERS

    def rounds(self, some: Cellwise) -> BracketContext:
        """What rounds of brackets of some cells need."""
        return BracketContext(
            scene=self.scene,
            lanes=self.lanes,
            path=self.path,
            ground=some.ground,
            cells=some.cells,
            tableau=self.tableau,
            summed=any(self.wanted),
            accuracy=self.accuracy,
            report=self.report,
            effort=no_effort(some.eps.size),
            brief=some.brief,
            workers=self.workers,
        )

    def attempt(self, some: Cellwise) -> SoFar:
        """Answers of some cells, and which of them have a bracket that stays open."""
        layout = lay_out(
            scene=self.scene,
            path=self.path,
            eps=some.eps,
            ts=self.ts,
            needs=some.needs,
            fast_slides=some.ground.fast_slides,
            accuracy=self.accuracy,
            summed=any(self.wanted) or self.every_slip,
        )
        values, left = close_brackets(self.rounds(some), layout, some.needs)
        answers = evaluate(
            scene=self.scene,
            path=self.path,
            ground=some.ground,
            ts=self.ts,
            layout=layout,
            values=values,
            wanted=self.wanted,
            accuracy=self.accuracy,
        )
        open_ = np.isin(np.arange(some.eps.size), layout.brackets.cell[left])
        return SoFar(some, answers, open_)

    def is_rough(self, answers: CellResults, eps: np.ndarray) -> np.ndarray:
        """Cells whose surveys are not good to the accuracy, or not known to be."""
        errors = [answers.survey_error / eps]
        if self.wanted.energies:
            errors.append(answers.survey_work_error)
        worst = np.max(errors, axis=0) / (ENCLOSURE_SETTINGS.closed * self.accuracy)
        return (worst > 1) | (np.isnan(worst) & (answers.status == int(Status.OK)))


def merged(every: Cellwise, *parts: tuple[np.ndarray, SoFar]) -> SoFar:
    """All cells from attempts at some of them each, in their order."""
    order = np.argsort(np.concatenate([which for which, _ in parts]))
    attempts = [part for _, part in parts]
    slides = np.concatenate([part.cells.ground.fast_slides for part in attempts])
    needs = concatenated([part.cells.needs for part in attempts])
    return SoFar(
        cells=every._replace(
            ground=every.ground._replace(fast_slides=slides[order]),
            needs=rows_of(needs, order),
        ),
        answers=rows_of(concatenated([part.answers for part in attempts]), order),
        open_=np.concatenate([part.open_ for part in attempts])[order],
    )
