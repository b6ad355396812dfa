"""How programs over intervals are cut: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """In numbers computed, unless said otherwise."""

    # Loops that are followed (`enclosure.py`).
    longest: int = 1000  # steps

    # Work and parts (`program.py`).
    unknown_loop: int = 16  # times that a loop of unknown length is taken to run
    callback: int = 2000  # take as long as a call of Python
    step: int = 256  # take as long as the overhead of a step
    largest: int = 2**15  # in one array, which stay in the cache
    many: int = 32  # terms of a sum among which those that move are looked for
    parts: int = 4  # that intervals are cut into for that
    few: int = 16  # intervals that are not
    leaf: int = 2**13  # in one array for which looking for terms that rest saves nothing
    # Of the largest term: widths of values below rounding; slopes and bends that move
    # nothing. (Slopes below 1e-16 still decide the sign between pulses far apart.)
    known: float = 1e-15
    rests: float = 1e-24


SETTINGS = Settings()
