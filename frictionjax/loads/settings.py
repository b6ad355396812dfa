"""How finely loads given as functions are looked at, and what counts as none."""

from typing import NamedTuple

import numpy as np


class Settings(NamedTuple):
    """Of cells of [0, T], of places that are not smooth, of samples."""

    # Cells by bounds (`cells.py`).
    first: int = 256  # cells at first
    # Into how many one is cut: a pulse of a millionth of [0, T] is reached in 5 cuts by 8
    # of 8 cells each, in 12 by 2 of 2.
    cuts: int = 8
    many: int = 2000  # are cut by 2, as most of them are decided by the next cut
    needle: int = 8  # spacings of floats at T: cells are not cut below this
    most_cells: int = 2**20  # looked at
    # Numbers in all steps of the function in these cells, which take 3 to 8 s.
    most_numbers: int = 2**25
    steepest_share: float = 0.25  # of these, for the steepest place
    # Of the load's mean slope `max |l| / T`: slopes that move nothing over all of [0, T].
    flat: float = 1e-12
    kink: float = 1e-9  # of it: kinks that are none
    rounded: float = 1e-15  # of max |l|: changes below its rounding
    steady: float = 1e-9  # of max |l|: what no jump is below
    too_large: float = 0.5 * float(np.finfo(float).max)  # N

    # Places that are not smooth (`needles.py`).
    jump: float = 1e-6  # of max |l|: what may change within a few spacings of floats
    # Changes that the slopes on either side explain: one of them holds at least half way.
    explained: float = 1.5
    # A change of slope that is a kink: of the slopes beside it. What l'' may do there is
    # less.
    kink_beside: float = 1e-6
    aside: int = 8  # shortest cells: from a place that is not smooth to what is beside it
    # Times that: closer and closer by 8. A power |t|^p rises by 8^-p of the step before, a
    # logarithm by 1.
    nearer: tuple[int, ...] = (512, 64, 8, 1)
    grows: float = 0.95  # of the step before: more is a logarithm's, or a pole's
    risen: float = 1e-9  # of max |l|, in each of them
    most_stretches: int = 2**15  # looked at

    # Cells by samples (`sampled_cells.py`).
    # Cells of which each is looked at from its ends and at two places inside. A pulse that
    # lasts longer than one is seen; of shorter ones, one in the share of its cell.
    sampled: int = 2**16
    fewest: int = 2**8  # of a long program
    chunk: int = 2**14  # times of one compiled call
    most_sampled: int = 2**20  # cells
    # Numbers of all samples, in all steps of the function, which take 5 to 10 s.
    most_sampled_numbers: int = 2**27
    most_at_once: int = 2**23  # numbers of a call
    # Of the range of l: what it may go off its way between samples at the end.
    unseen: float = 1e-6
    places: tuple[float, float] = (
        0.38,
        0.71,
    )  # in a cell: not where multiples of T/2^n are
    # Of max |l|: how well a cubic through the ends foretells values inside.
    foretold: float = 1e-7
    # Of the largest slope there and of the mean one: how well slopes. (By values alone
    # kinks passed in cells that are short.)
    foretold_slope: float = 1e-5

    # The course of a load (`course.py`).
    together: float = 1e-12  # of the duration: turning points that are one
    most_looks: int = 60
    steepest: float = 1.02  # of the steepest slope found: cells with lower bounds are left

    # Loads whose numbers are traced or may have changed (`completeness.py`).
    samples: int = 4096  # finds slow turns
    other_way: float = 1e-9  # of the largest |l|: what it may go there where it should not
    later: float = 1e-12  # of the duration: rounding of durations
    same: float = 1e-9  # of the largest |l|, of the duration: turning points that are one
    most_stated: int = 2**20  # turning points that a foreign class may state

    # Where loads are steepest (`steep.py`).
    steep_samples: int = 64
    # Intervals between samples that are looked into: a ramp that lasts a 1e-8 of the way is
    # found where it lifts the load by more than the bend of the rest.
    suspects: int = 4
    parts: int = 16  # of an interval, at every zoom
    zooms: int = 5

    # Triangles (`triangle.py`).
    # A kink computed as (2k+1) period/4 must already lie on the piece to its right, or an
    # integrator starting there sees the old slope: two roundings of slack.
    slack: float = 4 * float(np.finfo(np.float64).eps)


SETTINGS = Settings()
