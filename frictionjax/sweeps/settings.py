"""How densely graphs of a motion and of a limit that jumps are compared."""

from typing import NamedTuple


class Settings(NamedTuple):
    """In units of eps."""

    apart: float = 1 / 16  # points of both graphs, at most
    bent: float = 1e-3  # a step that is straighter is taken for a straight line


SETTINGS = Settings()
