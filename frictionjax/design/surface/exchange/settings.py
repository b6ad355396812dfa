"""How surfaces are found by rows that are added where they leave their bounds."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Of slopes seen, of shortest vectors, of linear programs."""

    # Slopes seen (`seen_slopes.py`, `least_seen.py`), shortest vectors (`shortest.py`).
    unseen: float = 1e-12  # of all weights: what is left of a wave is rounding
    rows_seen: int = 8  # a wave: rows are added where the range is left
    rows_ratio: int = 32
    # Of the range: how far beyond its ends is left to the last digits. At 1e-10 rows come
    # so near to each other that problems that have a solution seem to have none.
    over: float = 1e-6
    additions: int = 20
    seen_steps: int = 30
    ends_seen: float = 4e-15  # of their range
    touching: float = 3e-6
    impossible: float = 1e-12
    exchanges: int = 50  # a row
    place: float = 1e-5  # of the grid's width: the lowest slope's own is flat
    reached: float = 1e-9  # of the lowest slope
    rank_seen: float = 1e-9  # of the largest singular value

    # The steepest surface within bounds (`steepest.py`).
    scanned: tuple[int, int] = (16, 32)  # places of the lowest slope: 4 a harmonic
    peaks: int = 3  # of the scan, looked at closely
    steepest: float = 1e-2  # of the way between two places: where a peak is
    steeper_places: int = 8  # looked at next to a peak
    steeper: float = 1.0001  # times the best share: less is not looked at closely
    enough: float = 1.001  # share of the slopes asked for, beyond which none is looked for
    flat: float = 1e-9  # share that counts as none
    left: float = 1e-5  # how far beyond its bounds a surface may be: it is made smaller
    programs: float = 1e-9  # tolerances of linear programs

    # The least bent surface within bounds (`least_bent.py`), of them.
    inside: float = 2e-5  # kept, for what is left between rows and for the last digits


SETTINGS = Settings()
