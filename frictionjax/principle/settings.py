"""How finely, and with what slack: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Lengths in units of eps."""

    # K (`well_variation.py`, `joint.py`).
    newton: int = 6  # sweeps: H' is a parabola at worst, where xi is close to rho
    together: int = 64  # forces of one compiled call

    # Curves (`along_curves.py`).
    coarsest: float = 0.25  # samples that far apart resolve slips: farther, and
    # The straight line between them is cut into such pieces. (1/8: 3% too little, as the
    # way that costs least is taken in each; 1/32: 0.2%.)
    pieces: float = 2.0**-5
    most: int = 1 << 24  # of these


SETTINGS = Settings()
