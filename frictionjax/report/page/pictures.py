"""Figures in a page: vector graphics for light and dark, and in words."""

import base64
import html
import io
import re
from typing import Any, NamedTuple

import matplotlib
from matplotlib.figure import Figure

from .dark import darkened
from .markup import Html, inline

_WIDE = 6.0  # inches: beyond, a phone moves it sideways instead of making it small
_PIXELS = 96  # an inch, on screens
_LEAST = 58  # an inch, on phones: letters of 8 pixels
_FAR = 7.8  # inches: beyond, no phone shows all of it, and the page says so
_SETTINGS: Any = {"svg.fonttype": "path", "svg.hashsalt": "frictionjax"}
_PATH = re.compile(r' d="[^"]*"')
_DECIMALS = re.compile(r"(\.\d\d)\d+")
_NO_METADATA = dict.fromkeys(("Creator", "Date", "Format", "Type"))


class Captioned(NamedTuple):
    """A picture, `told`: what it shows with its numbers, and how to read it."""

    figure: Figure
    told: str
    caption: str


def shown(drawn: Captioned, name: str) -> Html:
    """A picture with its caption, for light and for dark pages; `name` for keys alone."""
    light = vector_graphic(drawn.figure)
    width, height = drawn.figure.get_size_inches()
    sizes = f'width="{round(width * _PIXELS)}" height="{round(height * _PIXELS)}"'
    image = (
        '<picture><source media="screen and (prefers-color-scheme: dark)" '
        f'srcset="{_data_url(darkened(light))}">'
        f'<img src="{_data_url(light)}" {sizes} alt="{html.escape(drawn.told)}"></picture>'
    )
    if width > _WIDE:
        image = image.replace(
            "<img ", f'<img style="min-width: {round(width * _LEAST)}px" '
        )
        label = html.escape(f"Picture: {name}")
        far = " far" if width > _FAR else ""
        image = (
            f'<div class="wide picture{far}" role="region" aria-label="{label}" '
            f'tabindex="0">{image}</div>'
        )
    return Html(f"<figure>{image}<figcaption>{inline(drawn.caption)}</figcaption></figure>")


def vector_graphic(figure: Figure) -> str:
    """The figure as SVG, the same every time, letters as curves."""
    buffer = io.StringIO()
    with matplotlib.rc_context(_SETTINGS):
        figure.savefig(buffer, format="svg", metadata=_NO_METADATA)
    text = buffer.getvalue()
    return _PATH.sub(_rounded, text[text.index("<svg") :])


def _rounded(path: re.Match) -> str:
    """Two decimals of points: half the size, and nobody sees the rest."""
    return _DECIMALS.sub(r"\1", path[0])


def _data_url(svg: str) -> str:
    return f"data:image/svg+xml;base64,{base64.b64encode(svg.encode()).decode()}"
