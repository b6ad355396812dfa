"""When a table stands for a part."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Of tables in place of parts."""

    places: int = 1024  # of the period at which both are asked
    chunk: int = 2048  # times at which both are asked at once
    # How far apart they may be, of the largest: far more than rounding, far less than what
    # verdicts go by.
    same: float = 1e-10


SETTINGS = Settings()
