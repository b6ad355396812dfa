"""One attempt at some cells of a sweep, and what is known after several."""

from typing import Any, NamedTuple

import jax
import numpy as np

from ..numerics import rows_of
from .enclosure import SETTINGS as ENCLOSURE_SETTINGS
from .enclosure import (
    BracketContext,
    CellBounds,
    Requirements,
    close_brackets,
    lay_out,
    no_effort,
)
from .equation import Status
from .lanes import LaneCells
from .sums import CellResults, Sums, evaluate


class Cellwise(NamedTuple):
    """What an attempt needs of each cell."""

    ground: CellBounds
    cells: LaneCells
    brief: np.ndarray
    needs: Requirements


def with_rows(column: np.ndarray, chosen: np.ndarray, rows: Any) -> np.ndarray:
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
        changed = with_rows(self.answers.status, chosen, int(status))
        return self._replace(answers=self.answers._replace(status=changed))

    def with_attempt(self, part: "SoFar", chosen: np.ndarray) -> "SoFar":
        """What another attempt has found; its steps are on top of those before."""
        before, new = rows_of(self.answers, chosen), part.answers
        answers = new._replace(
            steps=new.steps + before.steps,
            rejected=new.rejected + before.rejected,
            tolerance=before.tolerance,
        )
        return jax.tree_util.tree_map(
            lambda column, rows: with_rows(column, chosen, rows),
            self,
            part._replace(answers=answers),
        )


class AttemptContext(NamedTuple):
    """What all attempts share."""

    rounds: BracketContext
    ts: np.ndarray
    wanted: Sums
    every_slip: bool

    def rounds_of(self, some: Cellwise) -> BracketContext:
        """What rounds of brackets of some cells need."""
        return self.rounds._replace(
            ground=some.ground,
            cells=some.cells,
            brief=some.brief,
            effort=no_effort(some.brief.size),
        )

    def attempt(self, some: Cellwise) -> SoFar:
        """Answers of some cells, and which of them have a bracket that stays open."""
        rounds = self.rounds_of(some)
        summed = rounds.summed or self.every_slip
        layout = lay_out(rounds, self.ts, some.needs, summed)
        values, left = close_brackets(rounds, layout, some.needs)
        answers = evaluate(rounds, self.ts, layout, values, self.wanted)
        open_ = np.isin(np.arange(some.brief.size), layout.brackets.cell[left])
        return SoFar(some, answers, open_)

    def is_rough(self, so_far: SoFar) -> np.ndarray:
        """Cells whose surveys are not good to the accuracy, or not known to be."""
        answers = so_far.answers
        errors = [answers.survey_error / so_far.cells.ground.eps]
        if self.wanted.energies:
            errors.append(answers.survey_work_error)
        closed = ENCLOSURE_SETTINGS.closed * self.rounds.accuracy
        worst = np.max(errors, axis=0) / closed
        return (worst > 1) | (np.isnan(worst) & (answers.status == int(Status.OK)))
