"""What regressions and laws take for a power, a window, an order: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Of free fits, of curves that bend towards their power, of laws of theory."""

    # Free fits (`order.py`).
    least_points: int = 4  # two parameters, two left for the scatter
    # Errors below this many times their own uncertainty are left out.
    above_floor: float = 3.0
    windows: int = 5  # that are tried
    shortest_window: int = 5  # points, where there are more
    one_sided: float = 1.64  # sigmas, 95%: neighbouring residuals that differ by chance
    rare: float = 0.01  # chance that scatters of a window and of all points are one
    exact: float = 1e-12  # of log errors that follow a power to the last digit
    # Errors wave about their power with where slips fall, by a factor of up to this one,
    # and a window narrower than the second one may see a part of one wave alone, without
    # any scatter: five eps from 0.01 to 0.0104 gave [1.09, 1.54], which no 4% can show.
    waves: float = 1.25
    narrow: float = 3.0
    worst_misfit: float = 3.0  # factor by which a line may miss its points and still be one

    # Curves `log(1 + c e^(q x))` beside a line (`regression.py`), y the log error.
    level: float = 0.95  # of intervals
    slowest: float = 0.2  # q
    fastest: float = 3.0  # faster ones leave two points
    smallest: float = -0.95  # c at the largest x
    largest: float = 1e3
    # `c e^(q x)` at the smallest x: beyond, data are of something else.
    at_the_end: float = 0.5
    hidden: float = 0.05  # c that scatter may hide; of 12% behind 1%, 7 of 10 draws miss
    # Of chi^2, 90%, beyond the interval's own: a larger c is believed.
    evidence: float = 2.7
    cells_q: int = 8  # of the grid, at every zoom
    cells_c: int = 45
    zooms: int = 3
    even: float = 1e-4  # c is spaced evenly below, by equal ratios above
    line_only: int = 4  # points: nothing but a line
    logarithms: tuple[float, float, int] = (1e-2, 30.0, 120)  # from, to, how many
    rounding: float = 1e-13  # of y

    # Laws (`law_orders.py`).
    agrees: float = 0.05  # of an order: a prediction whose ratio drifts by more is none
    usable: int = 4  # cells
    seen: float = 1.5  # factor by which a law may miss its own power where that is seen
    # Of what the order of the ratio changes by. Of 45 intervals of the dissipation in 8
    # scenes 42 hold without it, 45 with half or all of it, 1.2 and 1.5 times as wide on
    # average; with the hull of both slopes 42, of a t interval of the smaller half 43, 1.6
    # times as wide.
    unsettled: float = 0.5


SETTINGS = Settings()
