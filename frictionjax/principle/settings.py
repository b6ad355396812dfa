"""How finely, and with what slack: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Lengths in units of eps."""

    # K (`well_variation.py`, `joint.py`).
    newton: int = 6  # sweeps: H' is a parabola at worst, where xi is close to rho
    together: int = 64  # forces of one compiled call

    # Curves (`along_curves.py`).
    coarsest: float = 0.25  # samples that far apart resolve slips: farther, and
    pieces: float = 0.125  # the straight line between them is cut into such pieces
    most: int = 1 << 24  # of these


SETTINGS = Settings()
