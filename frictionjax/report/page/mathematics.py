"""Formulas in ASCII as people write them by hand."""

import html
import re

from .markup import Html

_LETTERS = {
    "eps": "\u03b5",
    "gamma": "\u03b3",
    "Phi": "\u03a6",
    "alpha": "\u03b1",
    "beta": "\u03b2",
    "rho": "\u03c1",
    "omega": "\u03c9",
    "theta": "\u03b8",
    "mu": "\u03bc",
    "pi": "\u03c0",
    "sum": "\u03a3",
    "sqrt": "\u221a",
}
_RAISED = re.compile(r"\^(\([^()]*\)|-?[A-Za-z0-9]+(?:\.[0-9]+)?)")
_LOWERED = re.compile(r"(?<=[A-Za-z])_([A-Za-z0-9]+|\+|-)")
_WORD = re.compile("[A-Za-z]+")
_MARKS = {"\x01": "<sup>", "\x02": "</sup>", "\x03": "<sub>", "\x04": "</sub>"}


def equation(lines: str) -> Html:
    """Lines of a formula: Greek letters, powers raised, indices lowered, primes."""
    shown = "<br>".join(_line(line) for line in lines.splitlines())
    return Html(f'<p class="equation">{shown}</p>')


def _line(line: str) -> str:
    indent = len(line) - len(line.lstrip())
    marked = _RAISED.sub(lambda m: f"\x01{m[1].strip('()')}\x02", line.strip())
    marked = _LOWERED.sub(lambda m: f"\x03{m[1]}\x04", marked)
    written = _WORD.sub(lambda m: _LETTERS.get(m[0], m[0]), marked)
    text = html.escape(written.replace("'", "\u2032").replace(" - ", " \u2212 "))
    for mark, tag in _MARKS.items():
        text = text.replace(mark, tag)
    return f'<span class="where">{text}</span>' if indent else text
