"""Where fits of surfaces start, and what of their ends counts: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Of starts, of what is proven, of what is told."""

    # Problems (`fit.py`).
    kept: int = 1000  # steps that there is room for: other budgets compile nothing new
    # Above every multiplier of the extreme slopes, which their ratio raises.
    firm: float = 50.0
    follows: float = 0.9  # of the slopes allowed: the steepest that is expected
    uneven: float = 1e3  # ratio of the slopes expected, at most

    # Starts (`starts.py`).
    gentle: float = 0.3  # of the nearest bound, at most
    shares: tuple[float, float] = (0.02, 0.98)  # of the bounds of free parameters
    # Of the lowest slope, in periods from the highest, where heights are bounded.
    places: tuple[float, ...] = (1 / 2, 1 / 3, 1 / 4, 1 / 5, 2 / 5, 1 / 6, 3 / 8, 1 / 8)
    pad: float = 0.1  # of the range of slopes: from them to their bounds
    above: float = 1.1  # of the heights: their bounds
    towards: int = 16  # free parameters looked at on the way to those wanted

    # All starts (`multistart.py`).
    target_met: float = 1e-9  # relative error of a coefficient that counts as met
    small: int = 1000  # numbers that are copied sooner than spread, which takes 5 us
    # Of the energy: barriers leave 1e-4, with bounds on curvature 1.4e-3.
    proven: float = 5e-3

    # The closed form (`least_bent.py`).
    agreed: float = 1e-12  # of the targets, weighted: rounding of coefficients

    # Tips at different phases (`array_surface.py`).
    less_uneven: float = 0.9  # of what a ratio is above 1: the next one tried

    # What coefficients leave open (`open_directions.py`).
    rank: float = 1e-9  # of the largest singular value
    halvings: int = 6
    exact: float = 1e-12  # of the slopes

    # What bounds leave room for (`reachable.py`).
    samples: int = 512  # of free numbers within their bounds, ends not counted
    corners: int = 6  # free numbers of which every combination of ends is looked at
    no_stretch: float = 1e-12

    # Reports (`report.py`).
    sure: float = 0.99  # of random targets that agree with one surface, a smaller chi2
    tie: float = 1e-9  # relative difference of losses that counts as none
    near: float = 1e-3  # share of a bound that counts as reached


SETTINGS = Settings()
