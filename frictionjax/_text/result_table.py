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

    Prints itself in a shell and shows itself in a notebook; `.to_csv()`, `.to_latex()`.
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
        lines = [self._line("th", self.header)]
        lines += [self._line("td", row) for row in self.rows]
        note = f"<p>{html.escape(self.note)}</p>" if self.note else ""
        return f"<table>{''.join(lines)}</table>{note}"

    def _line(self, tag: str, cells: Sequence[str]) -> str:
        words = _flush_left(len(cells), self.left, self.meanings)
        shown = [
            f'<{tag} style="text-align: {"left" if i in words else "right"}">'
            f"{html.escape(cell)}</{tag}>"
            for i, cell in enumerate(cells)
        ]
        return f"<tr>{''.join(shown)}</tr>"

    def to_csv(self) -> str:
        """The cells, comma separated, as `csv` of Python's library reads them."""
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([self.header, *self.rows])
        return text.getvalue()

    def to_latex(self) -> str:
        """A `tabular` without packages."""
        count = len(self.header)
        words = _flush_left(count, self.left, self.meanings)
        columns = "".join("l" if i in words else "r" for i in range(count))
        head, *body = (" & ".join(map(_in_latex, row)) for row in (self.header, *self.rows))
        rules = [rf"{row} \\" for row in body]
        lines = [rf"\begin{{tabular}}{{{columns}}}", rf"{head} \\", r"\hline", *rules]
        return "\n".join([*lines, r"\end{tabular}"])


_LATEX = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
_LATEX |= {sign: f"\\{sign}" for sign in "&%$#_{}"}
_LATEX |= {sign: f"${sign}$" for sign in "<>"}


def _in_latex(text: str) -> str:
    return "".join(_LATEX.get(sign, sign) for sign in text)
