"""The skeleton of a page: head, what it says first, contents, sections."""

import html
from collections.abc import Sequence
from importlib import resources
from typing import NamedTuple

from .markup import Html, anchor_of, inline

# Nothing is ever loaded, and nothing runs.
_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"


class Section(NamedTuple):
    """A title, and blocks below it."""

    title: str
    blocks: Sequence[Html]


class Page(NamedTuple):
    """`about`: what was done; `verdict`: what came out, a sentence; `first`: beside it."""

    title: str
    about: str
    verdict: str
    first: Sequence[Html]
    sections: Sequence[Section]
    made_by: str


def page_text(page: Page) -> str:
    """The page as one file: style inside, no scripts, no requests."""
    style = resources.files(__package__).joinpath("page.css").read_text(encoding="utf-8")
    title = html.escape(page.title)
    entries = "".join(
        f'<li><a href="#{anchor_of(one.title)}">{html.escape(one.title)}</a></li>'
        for one in page.sections
    )
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{_POLICY}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<link rel="icon" href="data:,">
<style>
{style}</style>
</head>
<body>
<a class="skip" href="#main">Skip to the report</a>
<header>
<h1>{title}</h1>
<p>{inline(page.about)}</p>
</header>
<main id="main">
<section class="verdict" aria-labelledby="what-came-out">
<h2 id="what-came-out">What came out</h2>
<p>{inline(page.verdict)}</p>
{"".join(page.first)}
</section>
<nav aria-label="Contents">
<h2>Contents</h2>
<ol>{entries}</ol>
</nav>
{"".join(map(_section, page.sections))}
</main>
<footer>
<p>{inline(page.made_by)}</p>
</footer>
</body>
</html>
"""


def _section(section: Section) -> str:
    anchor = anchor_of(section.title)
    return (
        f'<section aria-labelledby="{anchor}">\n'
        f'<h2 id="{anchor}">{html.escape(section.title)}</h2>\n'
        f"{chr(10).join(section.blocks)}\n</section>\n"
    )
