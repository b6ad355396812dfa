"""The README taken apart: its blocks, its commands, and what the ten lines print."""

import re
from pathlib import Path

import numpy as np

HOME = Path(__file__).parents[2]
README = HOME / "README.md"
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
# Of `frictionjax study --eps 1e-3`, in a line of its own or in backticks, what follows.
_COMMAND = re.compile(r"(?<![\w/.])frictionjax ([a-z]+(?: [^`\n|&]*)?)[`\n|&]")


def blocks(page: Path, language: str) -> list[str]:
    """What a page holds between fences of a language."""
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(), re.DOTALL)


def shell_lines(page: Path) -> list[str]:
    """What may follow `frictionjax` in a shell, words of sentences among it."""
    return [line.strip() for line in _COMMAND.findall(page.read_text())]


def ten_lines() -> str:
    """The README's program."""
    (code,) = blocks(README, "python")
    return code


def require_what_ten_lines_print(printed: str) -> None:
    """Fail where a run of the ten lines printed other words, or other numbers."""
    (told,) = blocks(README, "text")
    assert _NUMBER.sub("#", printed).split() == _NUMBER.sub("#", told).split()
    found, expected = (
        [float(n) for n in _NUMBER.findall(text)] for text in (printed, told)
    )
    # Ends of intervals hang on the last digits of errors; steps on the machine.
    np.testing.assert_allclose(found, expected, rtol=0.02)
