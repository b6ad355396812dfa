"""How forces along a solution are read."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Counts, unless said otherwise."""

    rows: int = 512  # of one compiled call
    slack: float = 1e-9  # of what friction withstands: nearer to its edge is a slide


SETTINGS = Settings()
