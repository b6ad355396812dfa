"""What measured files are taken for, and how their gaps are filled: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Of axes in tables, units that nobody states, marks, gaps and rows."""

    # Rows or columns of positions (`axes.py`).
    even: float = 0.05  # of the step, or the last digit written
    exact: float = 1e-6  # of it, where heights are few
    # Heights of which no flank is as even, unless its neighbour is as straight.
    many: int = 8
    # Of the largest difference of other rows: that of the first two, where heights are few.
    unlike: float = 2.0
    as_steep: float = 2.0  # factor within which a row climbs as its neighbour

    # Numbers without a unit are m where they can be (`scales.py`). Micrometres beside
    # nanometres make a slope of 0.05 into 50.
    longest_trace: float = 1.0  # m
    steepest: float = 3.0  # mean slope

    # Marks that stand for a missing height (`sentinels.py`).
    huge: float = 1e30  # no height in any unit
    # In ranges of all other heights: how far off they are. Counts of 16 bits that fill half
    # of theirs leave -32768 0.4 ranges away; other values are heights there, a scratch or a
    # particle.
    far_mark: float = 0.1
    far: float = 1.0
    fewest: int = 16  # other heights that show a range
    flank: float = 0.1  # of that range: a neighbour so far out climbs to what lies apart
    # Of all heights, of which more than one value is needed.
    bulks: tuple[float, ...] = (0.5, 0.75, 0.9, 0.97)

    # Gaps (`gaps.py`).
    # Of the period, or one sample. A straight line over a tenth of a period misleads the
    # steepest slopes by 1 to 2% in a trace of 8 periods and 3 to 8% in one of 2 or 3; over
    # a quarter by 7 and 20%. A cubic spline is better on clean heights (0.3%) and lost on
    # noise of 3% (10 to 50%, over a tenth); the periodic fit through the rest likewise (10
    # to 24% in 2 or 3 periods).
    longest_gap: float = 0.1
    most_missing: float = 0.1  # of a row: with more, 10% in a trace of 3 periods
    harmonics: int = 8  # that the period is found by

    # Friction over rows (`fit.py`).
    blocks: int = 10  # of neighbouring rows, which are not independent of each other


SETTINGS = Settings()
