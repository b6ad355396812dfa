"""Pages keep their promises: code runs, links lead somewhere, names and options exist."""

import contextlib
import io
import itertools
import re

import numpy as np
import pytest
from PIL import Image, ImageSequence
from readme import (
    HOME,
    README,
    blocks,
    require_what_ten_lines_print,
    shell_lines,
    ten_lines,
)

import frictionjax as fx
from frictionjax.cli import main

PAGES = [
    README,
    *sorted(HOME.glob("frictionjax/**/*.md")),
    *sorted(HOME.glob("benchmarks/*.md")),
    *sorted(HOME.glob(".github/*.md")),
]


def test_the_ten_lines_print_what_the_readme_says():
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(ten_lines(), "README.md", "exec"), {})
    require_what_ten_lines_print(printed.getvalue())


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(HOME)))
def test_links_lead_somewhere(page):
    for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
        if not link.startswith(("http", "#")):
            assert (page.parent / link.partition("#")[0]).exists(), link


def test_the_moving_picture_is_small_and_moves():
    path = HOME / "frictionjax" / "sliding.gif"
    assert path.stat().st_size < 400_000
    with Image.open(path) as film:
        frames = [np.asarray(one.convert("L")) for one in ImageSequence.Iterator(film)]
    assert len(frames) > 30
    assert all(np.any(a != b) for a, b in itertools.pairwise(frames))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(HOME)))
def test_names_exist(page):
    for name in re.findall(r"\bfx(?:\.[a-z_A-Z]\w*)+", page.read_text()):
        found = fx
        for part in name.split(".")[1:]:
            found = getattr(found, part, None)
            assert found is not None, name


def test_commands_and_their_options_exist():
    seen = set()
    for line in (line for page in PAGES for line in shell_lines(page)):
        name, *rest = line.split()
        command = main.commands.get(name)
        if command is None:
            continue  # a word of a sentence
        known = {o for p in command.params for o in (*p.opts, *p.secondary_opts)}
        for option in (word for word in rest if word.startswith("--")):
            assert option.strip("[],.)") in known | {"--help"}, line
        seen.add(name)
    assert seen == set(main.commands)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(HOME)))
def test_benchmarks_that_pages_name_are_there(page):
    for name in re.findall(r"python (benchmarks/\w+\.py)", page.read_text()):
        assert (HOME / name).exists(), name


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(HOME)))
def test_files_and_folders_that_pages_name_are_there(page):
    """Those of Python, by the end of their path."""
    for name in re.findall(r"`((?:\w+/)+(?:\w+\.py)?)`", page.read_text()):
        assert any(HOME.glob(f"**/{name}")), name


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(HOME)))
def test_python_in_pages_can_be_read(page):
    for code in blocks(page, "python"):
        compile(code, str(page), "exec")
