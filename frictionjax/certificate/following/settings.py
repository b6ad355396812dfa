"""Where solutions set off, their steps, and how many of them go at once."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Lengths in periods, that is in units of eps."""

    # Where they set off, beside the curve.
    aside: float = 0.03  # noise of eps/100 was 0.0134 off at most (by hand), shifts 0.09
    hurry: float = 0.2  # at most so much more where tips are on their way to rest
    late: float = 0.01  # of the time in which the limit slides by eps: the same instant
    slowest: float = 0.01  # of the fastest slide, to say which time that is

    # Steps.
    # Of a step; slips make up to a million times that of it, which is less than a moment
    # (`late`). 1e-8: twice the steps, and nothing else.
    error: float = 1e-6
    # Between its ends, where cubics tell where a tip is, and are a sixteenth of that off:
    # without, one was 3,471 eps astray at eps = 2e-3, gamma = 2.4 (by hand).
    between: float = 1e-3
    rounds: int = 4  # of Newton's method; with 3 a third more steps
    farthest: float = 0.15  # that one step goes: never into another well, as 0.5 did
    first: float = 1 / 256  # step, of a stretch
    shortest: float = 1e-13  # step, of the time: loads that jump
    # Followers side by side, and steps of one call.
    lanes: int = 64
    tries: int = 32
    most: int = 4096  # tries of a stretch: what comes later in it is not known


SETTINGS = Settings()
