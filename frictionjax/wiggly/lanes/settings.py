"""How lanes step, which loop they go through, and where they wait: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Of compiled loops, of queues, of steps at folds."""

    # Loops (`loops.py`).
    # Lanes side by side. Microseconds of a step of the loop: 0.72 at 4, 0.92 at 8, 1.43 at
    # 16, 2.49 at 32, 4.23 at 64, 8.65 at 128.
    width: int = 64
    narrow: int = (
        8  # of the loop of few jobs, or of few long ones: its steps take less time
    )
    # Seconds of a narrow loop's step, of a wide one's. (Between 0.15 and 0.33 sweeps take
    # the same.)
    narrow_step: float = 0.22
    # Wells that lanes of a narrow loop go through until another thread has taken its share.
    # (Two threads for 60 to 90 wells: each goes through a lane as long as the longest, in
    # twice the CPU time.)
    handed_over: float = 20.0
    with_sums: float = 1.5  # times as long as a step that adds up nothing
    # What is lost in a loop that is there before the fastest is compiled beside it, and for
    # how much more it is waited for: in wells of a lane of the wide loop, 0.13 ms each,
    # where a loop takes 0.4 s of a core to load, 2 s to compile.
    patience: float = 400.0
    at_once: float = 16_000.0
    # Rows of the smallest tables: cells, jobs, legs, and how much larger the next are. Each
    # size costs 0.4 s to trace and load, 2 s to compile, an empty row next to nothing: so
    # few sizes.
    room: tuple[int, int, int] = (256, 8192, 16384)
    growth: int = 16

    # Queues (`queue.py`).
    # Share of the lanes that may wait while others step. (As counted, values of 24 scenes:
    # 0.95 of the lane-steps of 64 lanes are of use; with 0.25 a fifth longer, as each leg
    # is handed over in a fifth of a step, whether many are at once or few.)
    idle: float = 0.03

    # Folds (`fold_steps.py`).
    # Folds of e that a tip may leave an unstable branch by in one step. Steps through slips
    # have 0.6, and up to 1.5; beyond 1/gamma = 4.7 the method's linear equations change
    # sign.
    most_folds: float = 3.0
    # Of its way: what a step of a slow tip that speeds up may be off the mean of its
    # velocities, and from where on the tip rests first, then slips. (Instants before slips
    # were 1.6 times the accuracy off without. Of 98,000 steps in 48 cells eleven erred by
    # more than 5 tolerances, up to 25: seven of them are 0.17 to 0.75 off. 0.3% more steps
    # in all, 0.9 to 1.6% at gamma >= 1.5, where 15 to 18% without the second number.)
    uneven: float = 0.15
    sudden: float = 1.0
    left: float = 1e-4  # of a slip's energy: residual of a step that ends in one
    spacing: float = 2.0**-52  # of floats, at most, over their size
    # Of t: where the load turns it has no slope, but in 1e-8 again.
    longest_pause: float = 2.0**-36
    rounding: float = 2.0**-51  # of forces that cancel and of times: four of each


SETTINGS = Settings()
