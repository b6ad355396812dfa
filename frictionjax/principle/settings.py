"""How finely, and with what slack: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Lengths in units of eps."""

    # K (`well_variation.py`, `joint.py`).
    newton: int = 6  # sweeps: H' is a parabola at worst, where xi is close to rho
    together: int = 64  # forces of one compiled call

    # Curves (`along_curves.py`).
    pieces: float = 0.125  # in which a well is gone through
    most: int = 1 << 23  # of them
    places: int = 1 << 12  # of one compiled call


SETTINGS = Settings()
