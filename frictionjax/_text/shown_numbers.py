"""Results that show themselves: a line for each number, with its unit and meaning."""

from typing import Any, NamedTuple

import numpy as np

from .._checks import as_text, has_numbers, notebook_text
from .result_table import ResultTable

_MOST = 40  # lines of a batch that are shown


class Named(NamedTuple):
    """A number of a result, or of each of a batch, with its unit; None: there is none."""

    name: str
    value: Any
    unit: str = ""
    meaning: str = ""


class ShownNumbers:
    """Base of results that are a few numbers: `table()`, and HTML in notebooks.

    An implementer says in `_numbers` which. A result with a `status` shows that first.
    """

    __slots__ = ()

    def _numbers(self) -> list[Named]:
        raise NotImplementedError

    def table(self) -> ResultTable:
        """Numbers with units and what they mean; of a batch a line for each member.

        Raises `ValueError` under a trace, where nothing is known yet.

        >>> fx.solve_limit(scene).table()
        number           value  unit  meaning
        status              OK        every number can be trusted
        time                 3  s     the last one
        z            -0.120394  m     the state then
        dissipation   0.379616  J     into friction
        """
        if not has_numbers(self):
            raise ValueError(f"{type(self).__name__}: needs known numbers, not a trace")
        told = [number for number in self._numbers() if number.value is not None]
        status: Any = getattr(self, "status", None)
        if np.ndim(status):
            return _of_batch(told, status)
        return _of_one(told, status, getattr(self, "message", ""))

    def _repr_html_(self) -> str:
        return notebook_text(self, self.table)


def _of_one(told: list[Named], status: Any, message: str) -> ResultTable:
    ended = [] if status is None else [("status", status.name, "", message)]
    lines = [(name, as_text(value), unit, why) for name, value, unit, why in told]
    header = ("number", "value", "unit", "meaning")
    return ResultTable(header, (*ended, *lines), meanings=2)


def _of_batch(told: list[Named], status: Any) -> ResultTable:
    count = np.size(status)
    columns = [[str(i) for i in range(count)], [s.name for s in np.ravel(status)]]
    for number in told:
        values = np.broadcast_to(np.asarray(number.value), np.shape(status))
        columns.append([as_text(value) for value in values.ravel()])
    units = (f"{n.name}/{n.unit}" if n.unit else n.name for n in told)
    rows = tuple(zip(*columns, strict=True))
    note = f"{count - _MOST} more, not shown" if count > _MOST else ""
    return ResultTable(("", "status", *units), rows[:_MOST], left=2, note=note)
