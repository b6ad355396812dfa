"""How slip maps are cut, solved and trusted, where fast slides begin: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Lengths in wells, shares of a shift that a well leaves, unless said otherwise."""

    # Transits of a well (`transit.py`).
    depth: int = (
        26  # halvings of the period: folds narrower than 1e-8 of it are not resolved
    )
    fine: float = 1e-8  # of the whole integral: last coefficients of a panel that is halved
    # Of it: last coefficients of panels in s, at most; transits err by less than its
    # square.
    rough: float = 1e-4
    panels: tuple[int, ...] = (4, 6, 8, 12, 16, 32, 64)  # in s, how many there may be
    # Pulls beyond the fold under which transits are looked at, each so many times the last,
    # and how much rougher they may be under the larger ones (1.4 times at folds with a
    # curvature; 100 and more at flat ones, until graded for all).
    pulls: int = 5
    pull_levels: float = 30.0
    rougher: float = 4.0
    place_sweeps: int = 4  # of Newton's method for the place at an s
    # Corners: panels halved in y (`halved_panels.py`). How much less each may err by, how
    # much what series miss at their ends counts, and to how many they are filled up.
    halved: float = 1e-2
    end_weight: float = 0.03
    halved_sizes: tuple[int, ...] = (32, 64, 128)
    # Sweeps of Newton's method from a guess that keeps the force constant. (Five before
    # others that follow: a slip map takes a seventh longer, and not one of those fewer.)
    first_sweeps: int = 3
    near_sweeps: int = 1  # from the times of a transit nearby
    lone_sweeps: int = 5  # from the constant force, where none follow
    tracks: int = 16  # in a compiled call
    near: int = 256  # Taylor series of one compiled call
    # Of a panel's polynomial, and with it transits of a track side by side.
    degree: int = 12

    # Times of transits as series (`transit_times.py`).
    number_sweeps: int = 6  # of Newton's method for the number at a time, at most
    settled: float = 1e-13  # what they leave in x

    # How far tips lag (`contraction.py`).
    # Half of the grid over a well, graded towards the fold by this many e-folds, which
    # resolve folds down to 1e-13 of a period.
    e_folds: float = 30.0
    half_grid: int = 256  # places
    thin: int = 3  # 255 is a multiple, so that the fold stays on the grid
    lag_forces: tuple[int, int, int] = (-24, 4, 85)  # decades from, to; how many
    as_high: float = 0.05  # of the range of forces: how much lower other folds may be
    # Of that range: by how much samples may miss a fold (0.0012 of a wave with 64 of them).
    missed: float = 2e-3
    wells_together: int = 2  # in a compiled call

    # How soon tips are beyond a fold (`landings.py`).
    latest: float = 0.45  # later ones hardly rest before the next fold
    landings: int = 32  # in a compiled call

    # First wells of a slide (`slow_flow.py`), in times in which it is forgotten.
    sets_off: tuple[int, int, int] = (-9, 0, 400)  # decades from, to; how many
    goes_on: tuple[float, float, int] = (1.05, 25.0, 480)  # from, to, how many

    # The averaged equation (`averaged_equation.py`).
    steps: int = 96  # of a slide, from its start to its end
    short: float = 4.0  # first step and last
    # Forces of the table, over the one at the start: from, to.
    table_forces: tuple[float, float] = (1e-3, 1e4)
    table_rows: int = 48
    step_sweeps: int = 8  # of Newton's method in a step
    farthest: float = 2.0  # change of log X in a sweep
    last_change: float = 0.01  # of log X, in the last sweep
    slides: int = 4  # in a compiled call

    # Panels of wells (`elements.py`).
    smallest: float = 8.0  # panel
    before: float = 12.0  # since the set-off where a slide begins, about: singular there
    end: float = 3.0  # left before the end of a slide
    growth: float = 1.5  # of the way so far, at most: times may bend for other reasons
    # Of a panel: what is left at the end is no panel of its own, but near where the force
    # would vanish, where six of 21 stretched ones did not hold.
    stretch: float = 1.3
    first_of_two: float = 0.6  # of what is left: there it is cut in two
    recovers: float = 0.7  # power of a panel's share for the next (1: twice as many panels)
    # As the averaged equation has it: a little less than what the recursion may show.
    slower: float = 0.4

    # The recursion on panels (`map.py`).
    newton: int = 6  # sweeps
    converged: float = 1e-4  # what these leave, by how their corrections shrink, at most
    left_over: float = 0.3  # and of the last coefficients allowed
    # A slide is slow where a transit forgets more than this of a shift: tips nearly rest at
    # folds, and windows started a few slips earlier do as well. (With 0.2 slow ends cost a
    # tenth to a third less, and times near slips there are 7e-5 eps off for 1e-5; below
    # that transits of a sine converge no more.)
    slow: float = 0.3
    on_above: float = 0.5  # at the end of the last panel: the slide may go on
    again: float = 0.6  # of a panel that does not hold, and of those behind it
    # Of the accuracy: last coefficients of a panel where slides are surveyed. (Surveys
    # through longer panels are rougher: at gamma = 1/4, eps = 1.3e-4 with 1e-2 made twice,
    # in 1.7 times the steps; with 1e-3 too many panels at eps = 1.3e-8 of the angular
    # scene, whose brackets stayed open.)
    tail: float = 3e-3
    # The same where they are not. (Errors of times as lanes measure them are the same with
    # either, at gamma = 1/4 up to 17 times larger at 0.03.)
    bare_tail: float = 1e-2
    spacing: float = 1e-14  # of T: rounding of times, in the last coefficients
    # Of the panel before: the smallest one worth trying where slides turn slow.
    worth: float = 0.2
    # Of the wells that the pace at a panel's start would pass before the end.
    slowing: float = 0.7
    rounds: int = 40

    # Fast slides (`fast_slides.py`).
    narrow: float = (
        0.2  # of the force beyond the fold at the start: the smallest on the way
    )
    # Of the accuracy: what errors of transits may add up to, about. (gamma = 1/2, accuracy
    # 1e-3: errors of slip maps as with 1e-4, in 40 nodes for 60.)
    of_accuracy: float = 0.3
    # Roughest transits. (gamma = 1/4, eps = 1e-8: brackets of 1.4e-3 eps with more than
    # 2e-4, of 2.3e-4 with less.)
    roughest: float = 1e-3

    # Where they begin (`onsets.py`).
    # Behind the tip, where the slip map takes over: transits change slowly enough for
    # panels of 16 wells (8 wells: tails 100 times larger).
    first: float = 16.0
    overshot: float = 12.0  # after a turn, at the pace before it
    still: float = 4.0  # of them that must have been passed for the slide to go on
    closed: float = 0.1  # of time: gaps of brackets at the start of a slide, at most
    long_lag: float = 100.0  # worth a slip map after the turn
    fast: float = 0.9  # share that a well leaves of a shift, where lags are many wells


SETTINGS = Settings()
