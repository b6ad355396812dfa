"""What is timed, how often, against what, and how far predictions go: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Errors and distances in eps, times in s, unless said otherwise."""

    # Instants (`instants.py`).
    slip_times: int = 32  # over one whole slip period
    shift: float = 0.005  # share of a slip period within which a slip is looked for
    moves: float = 0.05  # a slip moves z by more within both shifts of its instant
    other_pace: float = 0.25  # the limit moves by this more or less in no slip period

    # Measurements (`measurement.py`, `timed_runs.py`, `error_measures.py`).
    times: int = 61  # where none are given
    wrong: float = 0.5  # nothing that is so far off is a solution
    # Where all times asked for lie in slips, and states may be one apart.
    lost: float = 1.5
    least_relative: float = 1e-17  # error that counts as none
    # Of the fastest step through diffrax, whose loops cannot be stopped: bounds their
    # number. (1.2 to 2.4 us measured; at 3 us runs were ended that would have taken half
    # the time.)
    fast_step: float = 1e-6
    # Warm runs that are timed at least. (What took longer was timed once: half of the rows
    # had no spread.)
    least_runs: int = 3
    enough: float = 0.5  # after which no more are
    # That diffrax's solvers compile for before their first run ends: not begun with less.
    compiles: float = 10.0
    wanted: float = 1e-3  # accuracy that advice is given for, or the nearest one measured

    # References (`references.py`, `scipy_solvers.py`).
    one_by_one: float = 2e4  # slips that lanes one after the other may take, 0.4 ms each
    every_slip: float = 2e6  # slips that lanes side by side may take, 10 us each
    tighter: float = 1e-2  # of the accuracy
    tightest: float = 1e-9  # accuracy
    rtol: float = 1e-13  # SciPy warns of less than 2.2e-14

    # Records of steps (`step_record.py`).
    steps: int = 4096  # of one compiled call

    # The machine (`machine_cost.py`).
    machine_times: int = 61
    repeats: int = 2
    absurd: float = 1e15  # seconds or bytes that no machine takes
    # Of a process that has imported the library, and nothing more; and seconds of
    # compilation below which programs were there already. (A process of 5.8 GB that had
    # compiled all told every later one of so much, and of 0.005 s.)
    imported_bytes: float = 2e8
    warm: float = 1.0
    # Calls that take as long as the slip map of a slide beside its lanes: both are NumPy
    # and small programs. (Seven vertical cells of three slides 0.68 s, one 0.18, a call
    # 0.033.)
    map_calls: float = 0.4
    # And as a piece of the path between two turns of the load, which is looked through.
    # (2000 of them 1.4 s; foretold without 0.04 s for sweeps of 1.8 to 3.4.)
    piece_calls: float = 0.025
    # And as each of those that wait for the one before: where a load turns at speed, slides
    # cannot be looked at side by side.
    round_calls: float = 1.0

    # Predictions (`prediction.py`).
    # Factor that 95 to 100% of 96 cells stayed within (`benchmarks/cost_model.py`, nothing
    # else running; 83% while other programs came and went), and 23 of 24 under other loads.
    within: float = 2.0
    least_eps: int = 4  # that an order needs
    # Bytes of a leg in all tables, with the copies made on the way. What 8 vertical sweeps
    # added to a process, 0.1 to 1.3 GB, is within a factor of 1.6 of these
    # (`benchmarks/memory.py`); surveys made again and programs of other profiles come on
    # top.
    leg_bytes: float = 1200.0
    job_bytes: float = 1500.0
    value_bytes: float = 100.0

    # Grids for an order (`order_accuracy.py`).
    pilot: int = 48  # eps of the pilot: two seconds a gamma
    pilot_times: int = 2  # suprema are over all of [0, T] whatever times are kept
    # Of 4 and 5 the interval is luck: up to three times wider on the next such grid.
    points: tuple[int, ...] = (6, 8, 12, 16, 24, 32, 48)
    parts: int = 5  # ends of ranges: fifths of the pilot's
    # Of the distance of two eps.
    offsets: tuple[float, ...] = (0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75)
    # Intervals up to this many times what is wanted confirm. Those within it alone: nothing
    # was left beside an order of 1.3 +- 0.02 where grids of smaller eps gave 0.9 +- 0.06.
    judges: float = 5.0
    # Predictions are within a factor of two, but those of one pilot share most of that.
    tie: float = 1.25


SETTINGS = Settings()
