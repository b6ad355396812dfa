"""Blocks of a page. Whatever comes in is plain text, and is escaped here."""

import base64
import html
import re
from collections.abc import Iterable, Sequence
from typing import NewType
from urllib.parse import quote

from ..._text import ResultTable

Html = NewType("Html", str)
"""Text of a page: nothing else is put into one."""

_CODE = re.compile("`([^`]+)`")
_POWER = re.compile(r"\^(-?\w+(?:\.\d+)?)")
_NUMBER = re.compile(r"\d[\d.]*e[-+]\d+")
_OPTION = re.compile(r"(?<!\S)--[a-z-]+")
_LISTED = re.compile(r",(?=\S)")
_TO_ZERO = "eps\u00a0\u2192\u00a00"  # browsers break a line inside of `->`


def inline(text: str) -> Html:
    """A text, with code where backticks are, powers raised, and in one piece `eps -> 0`
    and numbers."""
    raised = _POWER.sub(r"<sup>\1</sup>", html.escape(text.replace("eps -> 0", _TO_ZERO)))
    return Html(_CODE.sub(r"<code>\1</code>", _NUMBER.sub(_whole, raised)))


def _whole(found: re.Match) -> str:
    """Browsers break a line after a hyphen, in `1e-03` and `--eps` too."""
    return f'<span class="whole">{found[0]}</span>'


def paragraph(text: str) -> Html:
    """A paragraph, see `inline`."""
    return Html(f"<p>{inline(text)}</p>")


def items(texts: Iterable[str]) -> Html:
    """A list of texts."""
    return Html(f"<ul>{''.join(f'<li>{inline(text)}</li>' for text in texts)}</ul>")


def definitions(entries: Sequence[tuple[str, str]]) -> Html:
    """Names, and what each is."""
    lines = (f"<dt>{inline(n)}</dt><dd>{inline(text)}</dd>" for n, text in entries)
    return Html(f"<dl>{''.join(lines)}</dl>")


def linked_files(files: Sequence[tuple[str, str]]) -> Html:
    """Files beside the page, and what each holds."""
    lines = (
        f'<li><a href="{html.escape(quote(name))}">{html.escape(name)}</a>: '
        f"{inline(text)}</li>"
        for name, text in files
    )
    return Html(f"<ul>{''.join(lines)}</ul>")


def preformatted(text: str) -> Html:
    """Lines as they stand; long ones go on below, after a space or a comma."""
    whole = _OPTION.sub(_whole, html.escape(text))
    return Html(f"<pre>{_LISTED.sub(',<wbr>', whole)}</pre>")


def table_region(table: ResultTable, caption: str, as_csv: bool = True) -> Html:
    """A table that is moved sideways, by keys too, where it is wider than the page.

    With its cells as CSV in a link. Captions are the names of the regions: one each.
    """
    label = html.escape(f"Table: {caption}")
    inside, closed, note = table.to_html(caption).partition("</table>")
    link = _csv_link(table, caption) if as_csv else ""
    return Html(
        f'<div class="wide" role="region" aria-label="{label}" tabindex="0">'
        f"{inside}{closed}</div>{note}{link}"
    )


def _csv_link(table: ResultTable, caption: str) -> str:
    csv = base64.b64encode(table.to_csv().encode()).decode()
    name = html.escape(f"{anchor_of(caption)}.csv")
    return (
        f'<p class="csv"><a download="{name}" href="data:text/csv;base64,{csv}">'
        f"These numbers as CSV: {html.escape(caption)}</a></p>"
    )


def anchor_of(title: str) -> str:
    """A title as the name of a place in the page, or of a file."""
    return re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-") or "part"
