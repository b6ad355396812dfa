"""How finely, and with what slack: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Lengths in units of eps."""

    # K (`well_variation.py`, `joint.py`).
    newton: int = 6  # sweeps: H' is a parabola at worst, where xi is close to rho
    together: int = 64  # forces of one compiled call
    # One in so many cells has a turn at most: a wave is seen in 16 places, halved twice.
    cells_a_turn: int = 8

    # Curves (`along_curves.py`).
    # Pieces: of a well at least, and samples that resolve its surface in each; of the load
    # from one edge to the next.
    of_wells: int = 8
    samples: int = 8
    of_load: int = 16
    most: int = 1 << 23  # of them
    places: int = 1 << 12  # of one compiled call


SETTINGS = Settings()
