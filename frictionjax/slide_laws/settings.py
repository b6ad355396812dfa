"""How finely wells and slides are tabulated, and what counts as none: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Places and widths in periods, forces as shares of the range of `W'`."""

    # The well over a period (`ingredients.py`).
    even_places: int = 1024
    nearest: float = 1e-4  # of more places on each side of an extreme, at equal ratios
    farthest: float = 0.06
    beside_extreme: int = 96
    together: int = 1032  # places of one compiled call: a zoom, or the even ones
    zooms: int = 4  # of the search for an extreme: 1e-11 of a period
    zoom_parts: int = 1024
    moments: int = 512  # of [0, T], beside the turning points of the load
    # Of the largest: there, and at half of it, V_eps' - W' is looked at.
    small_eps: float = 1e-3

    # Other tops of a well (`second_tops.py`).
    beside_top: int = 5  # places on each side that a polynomial goes through
    degree: int = 6
    width: float = 1e-3  # about the distance of the table's even places
    closest: float = 1e-8  # of more places on each side, at equal ratios
    more: int = 48
    deep: float = 0.5  # a maximum that lies deeper holds no tip
    equal: float = 1e-7  # heights that a sixth degree does not tell apart
    stands_out: float = 1e-9  # from its neighbours, at least; else it is flat

    # The gap to the fold's force (`well_force.py`).
    reliable: float = 1e-11  # what is smaller is rounding of W'
    no_gap: float = 1e-14
    decade: float = 10.0  # of distances from the top, over which its flatness is measured
    whole: float = 0.06  # flatness that is this near an even number is one
    flattest: float = 12.0  # beyond, a top is a straight flank
    long_flank: float = 0.25  # straight flanks that are looked at from their middle
    nearest_node: float = 1e-13  # nodes between the table's and that distance
    gap_nodes: int = 160
    passage_forces: tuple[float, float, int] = (1e-26, 1e3, 288)  # from, to, how many

    # Periodic solutions (`orbit.py`).
    # Nodes of a period with one top; twice as many change no prediction by more than 0.3%.
    # With two of one height a fold's delay came out 4.3 times too long on 256, within 1% on
    # 512.
    orbit_nodes: int = 256
    most_tops: int = 4  # that have nodes of their own
    nearly_top: float = 0.01  # a top that is lower by less has
    sweeps: int = 12  # of Newton's method; 2 to 4 are enough
    converged: float = 1e-5

    # Limits for eps -> 0 (`exponents.py`).
    same_gamma: float = 1e-9  # as the threshold
    high: float = 1e-6  # gap that is none
    small_drop: float = 1e-6  # of the force in a well: far enough down
    # Drop and drag of a tip that rests and then leaves its fold before the force has
    # dropped: drop/drag^2 is large, drop^2/drag small.
    resting: tuple[float, float] = (1e-9, 1e-7)

    # Errors of slides (`predictions.py`).
    # Speeds of slides that are solved, of the fastest; forces are interpolated between.
    speeds: tuple[float, ...] = (1e-3, 0.03, 0.1, 0.25, 0.45, 0.7, 1.0)
    alike: float = 1.02  # ratio of stiffnesses that are one
    stiffnesses: int = 4  # that are solved where they are not
    few_wells: float = 4.0  # of the way: fewer are no slide
    no_shift: float = 1e-6  # wells: the change of rho with eps is none
    tie: float = 1e-9  # of orders
    small_drag: float = 1e-5  # viscous force that is as good as none


SETTINGS = Settings()
