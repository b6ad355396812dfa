"""How far back lanes set off, how long they may take, what closes: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Lengths in wells, tolerances and gaps of the accuracy, unless said otherwise."""

    # Rounds (`close.py`).
    closed: float = 0.5  # of the accuracy: gaps of brackets accepted
    closer: float = 0.2  # of it, where one lane goes on alone
    rounds: int = 3
    earlier: int = 4  # times as far back in each round
    margin: int = 3  # one to fall behind, one to catch up, one to forget
    # Windows that set off further back look at how fast slides are, and which way they go.
    some_memory: float = 15.0
    long_memory: float = 100.0
    fast: float = 0.35  # steps a well where tips do not rest, of those elsewhere
    # Times what its longest job takes: the shortest block, where no larger loop is compiled
    # for one of full length, and else.
    longest_job: tuple[float, float] = (0.5, 1.5)
    filled: float = 0.9  # of a loop's rows, as workers have about as many each
    batch: float = 1e5  # a few seconds, between two reports
    # Steps beyond those for the wells of the path, of the longest lane in each march, added
    # up, that a cell may wait for in an attempt: 2 to 8 seconds. One lane alone, where that
    # is affordable, has its own budget. (Two knocks of 5 ms, gamma = 1/2, eps = 1e-5: where
    # tips do not follow, lanes went through 40 times the wells of the path, for maps that
    # never begin, and there was no answer in 10 minutes.)
    patience: float = 2e6
    path_steps: float = 200.0  # for a well of the path
    # Cells that remember more wells wait for more of their steps, for all where they
    # remember twice as many. (2e5 and 1e7, of 6e5 and 5e6 wells, at 40 times friction:
    # brackets went through them again and again, for minutes. No lane through more than 5e4
    # wells: turns of triangles at gamma = 0.15 to 0.35 lag by 1e6, which take 1e5 steps,
    # and ended open.)
    longest_memory: float = 5e3

    # Budgets of a lane (`brackets.py`). Steps are 10 to 200 a well.
    lane_steps: int = 2000  # for a well
    some_wells: int = 100  # more than the path's: lags let lanes pass through more
    # For a well that tips are behind by, which took 130 (gamma = 3/4).
    steps_behind: int = 500
    # Of a lane whose errors hardly add up, or that it remembers, twice.
    brief: float = 20.0

    # What counts as closed (`closeness.py`).
    slow_slip: float = 0.03  # of the largest speed: a slip's on a path that rests
    slip: float = 10.0  # times the path's speed: faster tips are in a slip
    # Of the path's speed: tips that are slower hang on a branch and forget there.
    creep: float = 1e-2

    # Requirements (`requirements.py`).
    forgotten: float = 0.1  # of the accuracy: what run-ups leave of a bracket
    after_slip: float = 0.05  # at which lanes may set off
    short_rest: float = 0.2  # the shortest that is worth it
    short_stay: float = 0.05  # in the well where both lanes set off
    # Lanes set off in the middle of a slip or two, and forget less in their first wells.
    # (1: brackets of gamma = 1, eps = 1e-2 stay open; a second round takes as long as the
    # first.)
    slips_forget: float = 1.5
    most_wells_a_leg: int = 16
    leg: float = 0.02  # of the whole way: the guide is a cubic on each leg
    # That a lane goes through beyond its run-up for a period or a time, and on average
    # where both set off in the tip's well, and one alone goes on.
    lane: float = 2.0
    settled_lane: float = 0.6
    affordable: float = 2e5  # for one lane alone, at most: a minute or two
    farthest: float = 2e6  # from z0 to the strip, at most: half a minute
    # Beside fast slides, in many lanes: more are laid out no more. (3.7e9 took minutes to
    # lay out, and would have taken days; 4e6 at turns of a triangle, eps = 1e-8, gamma =
    # 0.15, take 7 s.) And in cells that remember more than there is, where each lane has to
    # go through them.
    outside: float = 1e7
    outside_remembered: float = 2e6
    tail: int = 4  # before a turning point, always measured

    # Stretches and their ends (`layout.py`, `segment_ends.py`).
    apart: float = 1e-12  # of the duration: probes of which each ends a leg
    rounded: float = 16.0  # roundings of the path's states, which no leg is too long for
    guide: float = (
        0.05  # of the accuracy, in eps: how far a leg's guide may be off the path
    )
    leg_halvings: int = 40
    # Shares of a leg at which that is looked for: in the middle odd functions vanish.
    leg_places: tuple[float, float] = (0.27, 0.62)

    # Starts (`starts.py`).
    settling: float = 2.0  # from where lags are bounded to where slips are over in time
    aside: float = 1e-6  # of a stretch of time: where one-sided slopes are taken
    gap: float = 1e-6  # rounding of z/eps
    # Wells: at the bound itself lanes behind set off a well earlier, a fifth more steps.
    beyond: float = 1e-4
    faster: float = 1.5  # how much slides may have been, squared, where lanes set off
    # Lags that are longer are taken at the speed of the moment. (At the largest speed
    # always: lanes of 300 wells in slow parts of slides at gamma = 0.4, where ten do.)
    long_lag: float = 5.0
    whole: float = 1e-4  # rounding of times, in numbers of wells

    # Parts of slides that are sampled (`sampled_parts.py`).
    # For each node that is measured. On fewer, nodes moved to whole wells are no Chebyshev
    # points any more.
    sparse: int = 6
    sparse_behind: int = 20  # behind fast slides, where periods still change in shape
    dense: float = 1.2  # most nodes of a part, over the square root of its wells
    least_nodes: int = 17  # that there may always be
    even: float = 1e-3  # of the path's speed: what nodes may miss of it
    part_halvings: int = 40  # halves of halves of a part
    steady: float = 2.0  # largest speed over the smallest in such a part

    # What slip maps ask (`finder.py`).
    # Tolerance of the lanes that measure a slip map, of the tolerance of others. (gamma =
    # 1/2, eps 1e-3 to 1e-4, accuracy 1e-3: the same errors of maps from 1e-11 to 3e-8, in a
    # third of the steps; others add up to as much as 0.02.)
    tight_measure: float = 0.05
    # The tightest that is of use. (At accuracy 1e-6 brackets of eps = 1.3e-5 stay open with
    # 1e-10 at least.)
    tightest_measure: float = 1e-12
    tight_look: float = 0.2  # of the tolerance: lanes that lead to the start of a slip map
    # Error of a map at its start, as lanes leave it. (At 0.1 brackets of times in the first
    # wells of a slide stayed open where the tip was nearly in a slip.)
    set_off: float = 0.02
    least_error: float = 0.01
    # Share of the accuracy that rounding may take in a measurement of a slip map.
    noise: float = 0.03
    # That lanes go through for a measurement, at most. (eps = 1e-8, gamma = 1/4: lanes of a
    # twentieth of the wells find the same errors, in a third of the steps, where the
    # rounding of times is taken off, eight times larger ones where it is not; two wells
    # everywhere find 3.5 times larger ones.)
    most_checked: float = 400.0
    of_loads: float = 0.05  # of a spacing of times: what rounding of loads takes


SETTINGS = Settings()
