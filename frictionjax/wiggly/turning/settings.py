"""How scenes with rods that turn over are integrated."""

from typing import NamedTuple

from ..rosenbrock import RODAS5P, Tableau


class Settings(NamedTuple):
    """Counts, unless said otherwise."""

    tableau: Tableau = RODAS5P
    halvings: int = 60  # of the step on which a mode ends: its time to rounding
    room: int = 256  # steps of one call of a program: they are noted
    stride: float = 0.02  # of the reach: a step of a turning moves the root by that at most
    residual: float = 0.05  # of the energy of every slip made: that may be left unbalanced


SETTINGS = Settings()
