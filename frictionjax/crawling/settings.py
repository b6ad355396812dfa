"""How crawlers are integrated: with what lost."""

from typing import NamedTuple

from ..wiggly import RODAS5P, Tableau


class Settings(NamedTuple):
    """Counts, unless said otherwise."""

    tableau: Tableau = RODAS5P
    stops: int = 256  # of one compiled call; more are in rooms four times as large
    # Of the tolerance of a tip whose spring is held. (18 random crawlers, gamma 0.6 to 1.5,
    # eps 0.005 to 0.05, accuracy 1e-3, against runs at a thousandth of it: 1, 3, 10 are
    # off by 3e-5, 7.5e-5, 2e-4 eps at most, in 1, 0.87, 0.77 of the steps.)
    share: float = 3.0
    # Tolerances of runs over that, until two after each other agree.
    finer: tuple[float, ...] = (1.0, 0.3, 0.03, 0.003, 3e-4)
    # Speeds over the fastest slide's: 0.05 eps in 1/200 of a slip's time.
    in_slips: float = 10.0
    alike: float = 1e-9  # of friction: with the same both ways no foot knows to move first


SETTINGS = Settings()
