"""How steady slides are searched, and when designs for them have settled."""

from typing import NamedTuple

from ...tables import SETTINGS as TABLES

_TERMS = tuple(degree + 1 for degree in TABLES.degrees[1:])


class Settings(NamedTuple):
    """Of slides at several eps, of searches along a number, of designs."""

    # Periods (`periodic_orbit.py`).
    newton: int = 30  # steps, with a period's steps chosen anew each time
    newton_again: int = 12  # on the last of those
    rough: float = 1e-2  # of log D over a period: ends the first
    closed: float = 1e-12  # ends the others
    # Of the steepest wiggle, squared: a smaller c is replaced by it. Narrower landings than
    # floats near 1 resolve do not replay. `least_pull` tells what that adds to forces.
    least_pull: float = 2e-15

    # Curves of forces (`slide_curve.py`).
    knots: int = 4  # of a step, between which they are straight
    bristles: int = 20_000  # whose knots, 1500 each at most, are sorted

    # Slides (`slide_friction.py`).
    room: int = 4  # times as many eps in the next larger program with derivatives
    # Slides of known parts, rows of one program (`slide_rows.py`).
    rows: int = 2  # of a call
    harmonics: tuple[int, ...] = (8, 16, 64)
    # Of the bristle's series: one more than degrees. (One size of 9 left rods near upright,
    # of 12 degrees, without slides.)
    terms: tuple[int, ...] = _TERMS
    open: float = 1e-7  # of log D over a period: mean forces right to that
    # Of the force: more than that by a viscosity that floats resolve is told.
    added: float = 1e-5
    # Soft springs (`slide_friction.py`): relative errors of a period's steps, and the
    # most of the force that they may add up to while they are not forgotten. On a sine at
    # eps 1e-4, gamma 0.3 and 1 m/s, against the closed form, springs of 1, 0.1, 0.01 and
    # 0.001 N/m err by 4e-6, 1e-5, 4e-4 and 2e-3, and are told 7e-6, 7e-5, 7e-4 and 7e-3;
    # at 10 m/s they err a hundred times less than they are told.
    step_errors: float = 2e-8
    amplified: float = 3e-4

    # Searches along a number (`scan.py`), in shares of an interval.
    even: int = 33  # values of a slide, the ends with them
    # More by decades towards ends, where forces have poles: 10^-2 to 10^-6.
    decades: tuple[int, int] = (2, 7)
    sides: int = 257  # places where sliding is looked for, at no cost
    halvings: int = 50
    # Of a change to the one before: an end that the quantity grows towards.
    grows: float = 0.5
    # Of a bracket: how well an extremum's place is found, its value to 1e-12.
    turn: float = 1e-6
    flat: float = 1e-9  # of a value: smaller bumps are rounding
    touch: float = 1e-9  # of the target: an extremum that near to it is a solution
    width: float = 1e-13  # of a solution
    relative_width: float = 1e-14

    # Bristles (`bristle_fit.py`).
    together: int = 2  # slides of a call
    no_friction: float = 1e-6  # of drag: a target that drag alone meets
    pressing: float = 1e-3  # of the largest alpha: less hardly presses

    # Surfaces (`surface_fit.py`), in log forces.
    settled: float = 1e-6  # slides are right to 1e-7
    designs: int = 30
    far: float = 0.5  # the longest step
    step_halvings: int = 6


SETTINGS = Settings()
