"""How tips with mass are integrated: with what lost."""

from typing import NamedTuple

from ..rosenbrock import RODAS5P, Tableau


class Settings(NamedTuple):
    """Counts, unless said otherwise."""

    tableau: Tableau = RODAS5P  # L-stable: beta may be as small as it likes
    lanes: int = 8  # side by side: one vector; the slowest decides how long all take
    stops: int = 64  # of one compiled call
    shares: tuple[float, ...] = (0.25, 0.5, 0.75, 1.0)  # of a step, looked at for suprema
    # Of the tolerance of lanes without mass: slips are not forgotten.
    share: float = 1.0
    finer: float = 0.04  # tolerance of the second run over that of the first
    # Of a third run: two that hang on chance agree every other time.
    beside: float = 0.6
    checks: int = 128  # even times at which runs are compared, where suprema are wanted
    rounds: int = 2  # more, each finer again, where two runs end in different wells
    well: float = 0.5  # in eps: runs further apart are in different wells
    first_step: float = 1e-3  # of the shortest time of the system


SETTINGS = Settings()
