"""Sizes of tables: measured, with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Of series, of pieces, of points of loads."""

    # Harmonics of a series (`profiles.py`). Each size is programs to compile, 5 s of a core
    # for the first scene of that size. A step of a sine takes 0.126 us, in a table of one
    # harmonic, under a bristle of degree 1, it took 0.111, in one of 8, of degree 8, 0.157.
    # (A larger loop until the right one is there: last digits would depend on what has run
    # before.)
    harmonics: tuple[int, ...] = (4, 8, 16, 64)
    # Longer ones as pieces of this degree: 0.21 us for 0.25 with 16, 0.58 with 64. Plans
    # take as long as with series, and share their programs with functions in pieces.
    written_out: int = 8
    degree: int = 8
    # Samples of a function that may be a series: twice what 64 harmonics need. All of the
    # function's own points beside them have to be met.
    samples: int = 256
    negligible: float = 1e-15  # of how high it is, lowest to highest: what is left out
    met: float = 4e-14  # of that: how well samples between must be met

    # Pieces of a profile (`pieces.py`) and bins that find them.
    pieces: int = 4096
    bins: int = 2  # for each piece of the room
    # Of their polynomials: 4 is the degree of a corner of a polyline, a spline has 3. (One
    # size: 10 to 25% more for a step on a spline. Rooms for 64 and 512 pieces beside that
    # for 4096: 3% less at most, within what two runs differ by.)
    terms: tuple[int, ...] = (5, 9)
    few: int = 2  # pieces that may end within a bin
    # Of the largest value: how well pieces of a function meet it between their nodes. (Ten
    # roundings: at one, sines are never met.)
    fitted: float = 2e-15
    # The same of w'', whose own rounding is that of derivatives; and how far w, w' and w''
    # may be off at other places.
    bent: float = 2e-14
    alike: tuple[float, float, float] = (4e-14, 1e-13, 1e-10)
    # Pieces that all begin with, as what is left of w'' adds up along them; ends of these
    # this near a kink are left out, and Newton's steps to it.
    first_pieces: int = 16
    apart: float = 1e-3
    newton: int = 3
    place_rounding: float = 2.0**-51  # four of a share's: what their places are moved by

    # Sums of one function's copies (`summed_phases.py`).
    summed: float = 1e-12  # of the largest w'': how well pieces meet that of a sum
    summed_alike: float = 1e-10  # of the largest w': how far it may be off
    jumps: float = 1e-6  # of the largest third derivative: at a kink of the second
    alike_ends: float = 2.0**-40  # periods: ends of pieces that are one
    newtons: int = 8
    # Pieces. The second is programs of its own, for sums that the first has no room for.
    rooms: tuple[int, ...] = (4096, 32768)

    # Samples a period, which are static: few sizes, few programs.
    points_a_period: tuple[int, ...] = (256, 1024, 4096, 8192)

    # Points of a load (`loads.py`).
    points: tuple[int, ...] = (8, 64, 1024)
    # (4096 pieces alone: 10 to 20% more for a step.)
    load_pieces: tuple[int, ...] = (64, 4096)
    few_edges: int = 128  # that are all compared with a time
    times: int = 1024  # of a function, asked at once
    same: float = 1e-10  # of the largest: how far pieces may be off at other times
    # Bins for each piece of a function: pieces meet its kinks, and are halves of halves of
    # what is between these. (With those of a profile a bump beside two turns had no table.)
    function_bins: int = 16

    # Bristles as power series (`bristles.py`).
    nodes: int = 16
    # The paper's linear springs need degree 1, its angular spring 3 to 6 at slopes of 0.1
    # and eps = 0.1; 9 to 10 on the steepest surfaces that its contact allows, which fits to
    # traces try. (A size for degree 1: as for harmonics.)
    degrees: tuple[int, ...] = (4, 8, 12)
    least: float = 1e-14  # of the largest value: coefficients below are left out
    lowest: float = 1e-300  # m: heights below are none to a float

    # Supports as power series (`supports.py`).
    support_terms: int = 24
    # Of the forces that a support meets: how much further its series goes, as folds are
    # looked for at some places only.
    beyond: float = 0.25


SETTINGS = Settings()


def size_for(count: int, sizes: tuple[int, ...]) -> int | None:
    """The smallest size that holds `count`; None where none does."""
    return next((size for size in sizes if size >= count), None)
