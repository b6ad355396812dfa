"""Samples of a compiled call, and how long an asymmetric surface's series may be."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Of maps, of numbers that spread."""

    # Maps of designs (`maps.py`).
    smallest_wave: float = 1e-13  # of the first: the last one of an asymmetric profile
    most_waves: int = 512
    steepness: float = 0.2  # of a surface of which the asymmetry alone is asked for

    # Numbers that spread (`manufacturing.py`).
    chunk: int = 4096  # samples of one compiled call


SETTINGS = Settings()
