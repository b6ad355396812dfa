"""How numbers of designs are looked for, and what counts as rounding: with what lost."""

from typing import NamedTuple

import numpy as np

_ULP = float(np.finfo(np.float64).eps)


class Settings(NamedTuple):
    """Relative, unless said otherwise."""

    # What a fit is asked for (`targets.py`).
    hardly_wavy: float = 1e-9  # slope that every bristle follows

    # Coefficients on given slopes (`quantities.py`).
    no_force: float = 4 * _ULP  # of F''(0) times the height: alpha's own rounding

    # Effects (`scene_effects.py`).
    one_phase: float = 1e-9  # period: less changes the sum of forces by its square

    # Free numbers (`free_numbers.py`).
    # Where nothing bounds a number it is looked for up to this many times its own size.
    decades: float = 1e4
    tiny: float = 1e-12  # of its own size: where a positive one starts if bounds say 0
    alike: float = 1e-5  # six digits look the same
    rounded: float = 4 * _ULP  # how far a bound may be off its range


SETTINGS = Settings()
