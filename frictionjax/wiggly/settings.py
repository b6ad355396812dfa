"""How cells of a sweep are planned, tried again, and foretold: measured, with what lost."""

from typing import NamedTuple

from .rosenbrock import RODAS5P, Tableau


class Settings(NamedTuple):
    """Lengths in wells, unless said otherwise."""

    # Plans (`plan.py`).
    # Tiles of a cell, two lanes each: both queues full, twice. (Full once: 0.6 times as
    # fast for one cell, as lanes wait for the longest tile; three times: 0.7.) Of the whole
    # sweep (256) tiles were longer, a few percent of the steps fewer, and values depended
    # on the other cells, by up to a tenth of the accuracy.
    tiles: int = 128
    near_strip: float = 1e-3  # as near the strip, starts outside of it are forgotten
    # Accuracy: looser brackets and surveys save a fifth of the time, and at gamma = 0.75
    # were off by up to 6 times an accuracy of 1e-1, and twice one of 1e-2.
    loosest: float = 1e-3
    cells: int = 2  # in a compiled call, where one cell takes 0.1 ms
    phases: int = 1024  # bristles in a compiled call that finds their tips
    bristles: int = 4096  # of an array at once: 31 times take 0.2 GB
    slower: float = 0.1  # of the largest speed: there lags are compared with those at it
    square: float = 1.8  # powers of the speed that count as its square
    # Of the memory: shorter tiles repeat more, longer ones leave lanes idle. (gamma = 1/2,
    # 16 eps to 1e-4, seconds at 1, 1.5, 2, 3 and 5: vertical 0.74, 0.57, 0.62, 0.52, 0.45,
    # angular 2.1, 2.0, 1.9, 1.4, 1.6.)
    tile: float = 3.0
    # Rodas4P2 takes as many steps, each a quarter cheaper, and errs by more than 1e-3 of a
    # slip period at times near slips in 26 of 208 cells (gamma 0.65 to 2, eps 1e-3 to
    # 1e-6), by up to a well; this one in 7, and in 1 with the tolerances of now.
    tableau: Tableau = RODAS5P

    # Ways (`ways.py`).
    long_slide: float = 60.0  # worth a slip map, where windows set off far back
    # Windows that set off further back go by slip maps. (gamma = 0.6, eps = 1e-5, a sine:
    # 2.0e6 steps at 50 and 100, 2.6e5 at 25; gamma = 0.65: 3.8e5 at 25, and at 12 4.1e5 in
    # 1.5 times the time.)
    far_back: float = 25.0
    # That one lane from z0 goes through in about the time of the slip map of a slide, three
    # times these at least, for a sine. (16 eps to 1e-4, gamma = 1/2, seconds with maps from
    # 1100, 1800, 2500 and 4000 on: 0.35, 0.26, 0.25, 0.39. Whatever the number of slides:
    # 14 s for 200 of 190 wells each, which one lane goes through in 3.)
    worth_a_map: float = 2200.0 / 3
    burst: float = 0.1  # of the speed: what panels of a slip map might step over
    widest: float = 0.125  # reach of a sine, periods

    # Further attempts (`batch.py`).
    most_nodes: int = 65  # of a slide: where more are needed, every slip is measured
    surveys: int = 3  # made again, at most
    few_values: int = 500  # more are worth a guess at rooms
    # So few go through the narrow loop. (One cell of 2, 31 and 93 times at six eps from 0.1
    # to 1e-5 does; of 201 times one at 1e-3 and below goes through the wide one.)
    fewest_values: int = 100

    # Work foretold (`predicted_work.py`).
    # Steps a well: exp of a polynomial in the orders of magnitude of tolerance, drag and
    # reach, and in the lag, with knees at drags of 0.1 and 1. 280 cells of two scenes
    # (vertical and angular, gamma 0.5 to 2, eps 1e-1 to 1e-4, accuracy 1e-3 to 1e-6) lie
    # within a factor of 1.32 of it (rms), 85% within 1.5, all within 1.9. The angular scene
    # at gamma = 0.5 is apart: brackets there stay open at first, and steps are up to 5
    # times as many.
    constant: float = 1.278
    by_tolerance: float = 0.417  # an order of magnitude, downward
    by_lag: float = -0.092
    by_reach: float = 0.41  # what is narrower than a sine's
    by_drag: float = -0.131  # an order of magnitude, downward
    above_tenth: float = 0.505  # more, at drags above 0.1
    above_one: float = 1.466  # more, at drags above 1
    # Smaller drags change nothing. (Without, 2 and 5 times too few steps were foretold at
    # eps = 1e-8 for gamma = 1 and 2, and 14 times for the sawtooth.)
    smoothest: float = 2.0
    # Of a lane between two turns of the load, beyond those for its wells. (Never out of the
    # strip, 200 and 2000 turns: 291 at eps = 1e-2, 87 at 1e-5.)
    steps_a_piece: float = 150.0
    # Of one lane that goes on where drags are larger than friction: tips stay behind, and
    # steps for a well of the path are few. (0.2 of 3e7 wells at 2600 times friction: 12 s,
    # where maps and brackets had no end in 30.) So many times as many as foretold there;
    # tips that follow go through every well, with steps as foretold. (A sine of 5e3 N at
    # eps = 0.01, 2e6 wells at 500 times friction: no end in three minutes where only the
    # few were foretold, open after 0.7 s. 4e6 of these too: one of 40 cells at gamma 0.2 to
    # 0.7 ended open that takes 8.9e6, for 7.8e6 foretold, and 27 s.)
    lone_steps: float = 1e7
    guessed: float = 2.5
    # Slip maps: steps of a slide, from the orders of magnitude of its wells and of the
    # accuracy. 96 cells of four scenes (vertical, angular, sawtooth, quartic, gamma 0.4 to
    # 0.9, eps 1e-2 to 1e-8, accuracy 1e-3 and 1e-5) lie within a factor of 1.7 of it (rms),
    # 90% within 2; where slides turn out to be too slow for maps, up to 9 times as many.
    map_steps: float = 919.0
    map_orders: float = 1.85
    map_accuracy: float = 0.247
    # Segments of the lanes that measure a slide, for the square of these orders. (20 cells,
    # gamma 0.25 to 1, eps 1e-3 to 1e-7: 200 to 1900 a slide, within a factor of 2. As many
    # as brackets would have through the wells between: 3 GB foretold, for 5 MB.)
    map_segments: float = 25.0
    # The chain is for a thousand wells.
    map_chain: float = 4e2  # wells that lanes, one after the other, wait for each other
    map_growth: float = 0.05  # power of thousands of wells that both grow with
    # Drag of tips that are still on their way when a slide is over, and a rest begins.
    behind: float = 0.1
    # What a step costs more: for each harmonic and each degree of the bristle's series
    # beyond the smallest table (a sine in that of 8 harmonics and degree 8 takes 1.25 times
    # as long), in pieces (0.21 us for 0.16), for a bristle without a series.
    a_harmonic: float = 0.04
    in_pieces: float = 1.3
    a_degree: float = 0.02
    no_series: float = 3.0


SETTINGS = Settings()
