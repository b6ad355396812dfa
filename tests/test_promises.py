"""What users build on stays: public names, signatures, the shell's help."""

import re

import equinox as eqx
import pytest
from promised import FOLDER, PROMISES

import frictionjax as fx


@pytest.mark.parametrize("file", PROMISES)
def test_promises_are_kept(file):
    """A promise that grows is written anew: `python tests/support/promised.py`."""
    kept, now = (FOLDER / file).read_text(), PROMISES[file]()
    broken = sorted(set(kept.splitlines()) - set(now.splitlines()))
    assert not broken, f"no longer there: {broken}"
    assert now == kept, f"there is more: write {file} anew"


def test_help_lists_public_names_by_question():
    named = set(re.findall(r"`(\w+)`", fx.__doc__))
    assert named == set(fx.__all__) - {"__version__"}


@pytest.mark.parametrize("space", ["bristles", "profiles", "supports", "loads", "effects"])
def test_help_says_what_parts_there_are(space):
    home = getattr(fx, space)
    parts = {name for name in dir(home) if isinstance(getattr(home, name), type)}
    parts = {name for name in parts if issubclass(getattr(home, name), eqx.Module)}
    named = set(re.findall(r"\b[A-Z]\w+\b", home.__doc__))
    assert parts - {"AbstractPull", "AbstractSampled"} <= named
