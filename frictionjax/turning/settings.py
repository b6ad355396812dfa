"""How the limit system of rods that turn over is computed."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Degrees of Chebyshev polynomials over the whole turning, and counts."""

    degree: int = 32
    most: int = 128  # where h = L/20 chords come near 0 and 1e-7 is left
    left: float = 1e-14  # last coefficients, over the largest
    nodes: int = 16  # of the support's force: exact for a linear spring
    times: int = 512  # of one compiled call
    zooms: int = 7  # each by `times`, into the time of a level of the load
    table: int = 513  # places on a branch from which its equilibria are sought
    newton: int = 4  # steps from there: rounding after three


SETTINGS = Settings()
