"""How the barrier of a fit is followed, and its last digits found: with what lost."""

import math
from typing import NamedTuple


class Settings(NamedTuple):
    """Of rows, of Newton's method on the barrier, of last digits."""

    # Rows (`constraints.py`).
    rows: int = 32  # a wave: between two a series rises by 0.48% of its range more

    # The barrier (`iterates.py`): its weight.
    first: float = 1.0
    last: float = 1e-7
    shrink: float = 0.05
    # Squared decrement in units of the weight at which the next one is taken.
    centred: float = 3.0
    # Weight of the squared misfit, energy 1; settling removes what it leaves. (One that
    # grows as the barrier's falls moves the optimum between two barriers so far that
    # targets out of reach take 200 steps where 60 do.)
    firm: float = 1e4
    wall: float = 0.99  # share of the way to the nearest wall that a step goes at most
    backtracks: int = 40
    flattest: float = 1e-13  # of the largest eigenvalue
    # Share of the slopes allowed that free bristles keep away from their ends. The least
    # bent surface of a free bristle is often the one at which it hardly follows: an open
    # end, from which the last digits (5e-5 in slopes) could not be settled.
    edge: float = 1e-3

    # Last digits (`polish.py`), of the slopes.
    polish_steps: int = 40
    near: float = 0.03  # how far the last digits may move them
    smallest: float = 0.1  # that counts for that
    exact: float = 1e-12  # how well the surface has to have them
    # Of the largest singular value: directions that targets, or slopes, do not see.
    rank: float = 1e-9

    # The bound of the energy (`lower_bound.py`).
    there: float = 1e-3  # of the lowest slope: so near to it, a place is its own
    rounded: float = 1e-6  # of the energy, by which a bound of it may be above

    # Extreme slopes (`extreme_slopes.py`).
    fewest_waves: int = 4  # that rows are for
    slope_steps: int = 64
    exact_slopes: float = 2e-15  # of their range

    @property
    def row_margin(self) -> float:
        """Largest value on rows over the largest anywhere (Ehlich and Zeller, 1964)."""
        return math.cos(math.pi / self.rows)


SETTINGS = Settings()
