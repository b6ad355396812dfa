"""What parametrize is given: names of scenes, and which are slow."""

import pytest
from catalogue import HARD


def named(names=None, slow=()):
    """Names for parametrize; those that take long, or are in `slow`, are marked."""
    late = [name for name, one in HARD.items() if one.slow or name in slow]
    return [
        pytest.param(name, marks=pytest.mark.slow) if name in late else name
        for name in (HARD if names is None else names)
    ]
