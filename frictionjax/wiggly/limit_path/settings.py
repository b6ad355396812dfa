"""How a path is looked through, and how few periods stand for a slide: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Shares of a stretch of time, of a speed, of a shift; counts of samples."""

    # Where the path is (`path.py`, `find_path.py`).
    # That are all compared with a time, in half of a bisection's, and kept with a scene.
    few_pieces: int = 128
    roots: int = 128  # times of one compiled call
    brief: float = 1e-9  # of the duration: pieces of which floats leave little to look into

    # Where it is fast (`fast_stretches.py`).
    inside: float = 1e-9  # of a stretch of time: how far inside it its outer nodes are
    samples: int = 64  # of a piece
    fewer_samples: int = 16  # of a part of a piece
    # Of the samples: intervals that are looked into at least. (With four of 64, bursts that
    # were fifth or faster than others made suprema 17,000 times the accuracy wrong.)
    suspects: float = 1 / 16
    most_suspects: float = 1 / 4  # as many as have such a gap, up to here
    gap: float = 1e-4  # of the longest way: between the way of an interval and its speed
    parts: int = 16  # of an interval, at every zoom
    zooms: int = 5
    zoomed: int = 32  # intervals of one compiled call
    typical: float = 0.1  # of the median speed: slower ones are missed by shares of this

    # Where slides end slow (`resting_ends.py`).
    # Share that a well leaves of a shift, below which tips come to rest where the path
    # does: slides lag by half the wells that they remember, 1.4 here.
    rests: float = 0.7
    end: float = 8.0  # wells before a slide's end where it should be slow

    # Where the load turns at folds (`near_turns.py`).
    beside: float = 3.0  # wells that tips may be behind the path
    halves: int = 56  # of the duration: down to the spacing of floats

    # Sampled slides (`sampled_slide.py`).
    nodes: int = 17  # periods measured in a slide, unless it takes more
    fine: int = 257  # points at which extremes of the fitted curves are looked for
    magnified: float = 30.0  # by what a fit may magnify errors of what was measured
    places: int = 4  # at which that is looked for, for each coefficient
    fewer: float = 0.85  # coefficients, until it does not
    last: int = 3  # coefficients looked at
    uncertain: float = 5.0  # errors over them, where not all fit


SETTINGS = Settings()
