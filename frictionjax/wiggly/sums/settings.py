"""What sums over a cell are checked by."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Of energies of a cell, and of stops of one compiled call."""

    # Of the energy dissipated: residual of a balance that is good. Solutions leave about
    # 1e-6 of it.
    residual: float = 0.05
    # Dissipation over eps times what the load goes: less where nothing folds.
    no_slips: float = 0.1
    stops: int = 512  # of one compiled call


SETTINGS = Settings()
