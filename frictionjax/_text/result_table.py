"""Results as tables: under each other in a shell, as HTML in a notebook, in files."""

import csv
import html
import io
from collections.abc import Iterable, Sequence
from typing import NamedTuple


def in_columns(
    header: Sequence[str],
    rows: Iterable[Sequence[str]],
    left: int = 0,
    meanings: int = 0,
) -> str:
    """Columns under a header, two spaces apart, set flush right.

    But for the first `left` and the last `meanings`. Lines carry no trailing blanks.
    """
    cells = [list(header), *(list(row) for row in rows)]
    widths = [max(len(row[i]) for row in cells) for i in range(len(header))]
    words = _flush_left(len(header), left, meanings)
    lines = []
    for row in cells:
        texts = [
            text.ljust(width) if i in words else text.rjust(width)
            for i, (text, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(texts).rstrip())
    return "\n".join(lines)


def _flush_left(columns: int, left: int, meanings: int) -> set[int]:
    return {*range(left), *range(columns - meanings, columns)}


class ResultTable(NamedTuple):
    """Rows of texts under a header, and a note; columns as those of `in_columns`.

    Prints itself in a shell and shows itself in a notebook; `.to_html()`, `.to_csv()`,
    `.to_latex()`.
    """

    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    left: int = 1
    note: str = ""
    meanings: int = 0

    def __repr__(self) -> str:
        text = in_columns(self.header, self.rows, self.left, self.meanings)
        return f"{text}\n{self.note}" if self.note else text

    def _repr_html_(self) -> str:
        return self.to_html()

    def to_html(self, caption: str = "") -> str:
        """A `table` under its caption, with its note below; texts are escaped."""
        above = f"<caption>{html.escape(caption)}</caption>" if caption else ""
        head = self._line('th scope="col"', "th", self.header)
        body = "".join(self._line("td", "td", row) for row in self.rows)
        note = f"<p>{html.escape(self.note)}</p>" if self.note else ""
        lines = f"<thead>{head}</thead><tbody>{body}</tbody>"
        return f"<table>{above}{lines}</table>{note}"

    def _line(self, opened: str, closed: str, cells: Sequence[str]) -> str:
        shown = [
            f'<{opened} style="text-align: {self._side(i)}">{html.escape(cell)}</{closed}>'
            for i, cell in enumerate(cells)
        ]
        return f"<tr>{''.join(shown)}</tr>"

    def _side(self, column: int) -> str:
        words = _flush_left(len(self.header), self.left, self.meanings)
        return "left" if column in words else "right"

    def to_csv(self) -> str:
        """The cells, comma separated, as `csv` of Python's library reads them.

        >>> print(fx.solve_limit(scene).table().to_csv().splitlines()[2])
        time,3,s,the last one
        """
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([self.header, *self.rows])
        return text.getvalue()

    def to_latex(self) -> str:
        """A `tabular` without packages."""
        columns = "".join(self._side(i)[0] for i in range(len(self.header)))
        head, *body = (" & ".join(map(_in_latex, row)) for row in (self.header, *self.rows))
        rules = [rf"{row} \\" for row in body]
        lines = [rf"\begin{{tabular}}{{{columns}}}", rf"{head} \\", r"\hline", *rules]
        return "\n".join([*lines, r"\end{tabular}"])


_LATEX = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
_LATEX |= {sign: f"\\{sign}" for sign in "&%$#_{}"}
_LATEX |= {sign: f"${sign}$" for sign in "<>"}


def _in_latex(text: str) -> str:
    return "".join(_LATEX.get(sign, sign) for sign in text)
