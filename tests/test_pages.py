"""Pages keep their promises: code runs, links lead somewhere, names and options exist."""

import contextlib
import io
import itertools
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageSequence

import frictionjax as fx
from frictionjax.cli import main

HOME = Path(__file__).parents[1]
README = HOME / "README.md"
PAGES = [
    README,
    *sorted(HOME.glob("frictionjax/**/*.md")),
    *sorted(HOME.glob("benchmarks/*.md")),
    *sorted(HOME.glob(".github/*.md")),
]
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def blocks(page, language):
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(), re.DOTALL)


def words_and_numbers(text):
    """The words of a text, and its numbers."""
    return NUMBER.sub("#", text).split(), [float(n) for n in NUMBER.findall(text)]


def test_the_ten_lines_print_what_the_readme_says():
    (code,), (told,) = blocks(README, "python"), blocks(README, "text")
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "README.md", "exec"), {})
    words, numbers = words_and_numbers(printed.getvalue())
    words_told, numbers_told = words_and_numbers(told)
    assert words == words_told
    # Ends of intervals hang on the last digits of errors; steps on the machine.
    np.testing.assert_allclose(numbers, numbers_told, rtol=0.02)


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


def shell_lines():
    for page in PAGES:
        text = page.read_text()
        for line in re.findall(
            r"(?<![\w/.])frictionjax ([a-z]+(?: [^`\n|&]*)?)[`\n|&]", text
        ):
            yield page.name, line


def test_commands_and_their_options_exist():
    seen = set()
    for page, line in shell_lines():
        name, *rest = line.split()
        command = main.commands.get(name)
        if command is None:
            continue  # a word of a sentence
        known = {o for p in command.params for o in (*p.opts, *p.secondary_opts)}
        for option in (word for word in rest if word.startswith("--")):
            assert option.strip("[],.)") in known | {"--help"}, f"{page}: {line}"
        seen.add(name)
    assert seen == set(main.commands)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(HOME)))
def test_benchmarks_that_pages_name_are_there(page):
    for name in re.findall(r"python (benchmarks/\w+\.py)", page.read_text()):
        assert (HOME / name).exists(), name


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(HOME)))
def test_python_in_pages_can_be_read(page):
    for code in blocks(page, "python"):
        compile(code, str(page), "exec")
