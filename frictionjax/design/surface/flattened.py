"""The least bent surface whose lowest slope, or highest, is flattened.

In NumPy, as in closed form: nothing to compile. A barrier asks for the lowest slope half a
period from the highest, where ripples of the optimum need not touch it: it ended up to 7%
above the optimum (ratio 3.9 of slopes, 4 harmonics), and of 2 harmonics it found none next
to the largest ratio.
"""

from .barrier import FitShape, FitTask, kernel_ratio
from .exchange import least_bent_seen, plain_slopes
from .least_bent import for_all_starts, slopes_agreed, uneven
from .multistart import StartRuns


def flattened(layout: FitShape, task: FitTask, starts: int) -> StartRuns | None:
    """The optimum, by one start in a step, for all; None where it is another problem's.

    It is that of a least distance (`exchange/least_seen.py`) where the ratio of the slopes
    flattens one, all targets agree on them, and no bound on the curvature is felt.
    """
    ends = slopes_agreed(layout, task)
    if ends is None or not kernel_ratio(layout.harmonics) < uneven(ends):
        return None
    found = least_bent_seen(plain_slopes(layout.harmonics), ends)
    if found is None:
        return None
    return for_all_starts(layout, task, starts, ends, found.waves, found.bound)
