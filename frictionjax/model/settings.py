"""What scenes are checked by, and how finely: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Lengths in periods, unless said otherwise."""

    # Scenes (`scene.py`).
    traced_turns: int = 64  # of a load whose numbers are traced: room for them
    most_turns: int = 2**20  # in a scene: 8 MB a copy of their times
    # Rooms for edges of a load: the smallest, and up to where each is four times the last.
    edges: int = 8
    many_edges: int = 2048
    # Smallest eps, of the largest |z|: rounding of z itself is 1e-4 eps there. (At 1e-13 to
    # 3e-13 most sweeps of five scenes held ROUGH_SURVEY, at accuracy 1e-3; at 5e-13 to
    # 8e-13 a stiff one did, and 1 in 100 above.)
    told_apart: float = 2.0**-40
    times_told: int = 6  # wrong ones that are told to the last digit; more are rounded
    rounded: int = 8  # spacings of floats by which a time may exceed the duration

    # Admissibility (`admissibility.py`, `clearance.py`).
    margins: int = 2  # eps of one compiled call
    clearance_places: int = 512  # for the tip and for what is ahead of it
    # From and to how far away in m, and in how many places, a support is asked why it
    # does not reach a force.
    bend_places: tuple[float, float, int] = (1e-6, 1e6, 121)

    # Digits of the potential (`digits.py`).
    places: int = 256  # off the grid of round phases
    stretches: int = 16  # of a period: a jump or a narrow bump fills half of none
    inside: float = 1e-7  # before the seam
    neighbours: float = 2.0**-20  # apart: 64 harmonics bend by 1e-13 of themselves there
    # Noise, of the range of W: energies of wells, a slip has its digits then.
    most_of_w: float = 1e-7
    most_of_force: float = (
        1e-9  # of the range of W': slips would come at times of their own
    )
    most_of_q: float = 1e-3  # of the largest |Q| and |Q'|: less is no Q any more
    noises: int = 8  # eps of one compiled call

    # A rest that is given (`given_rest.py`).
    seam: float = 1e-6  # of the largest value, as of W
    above_noise: float = 20.0  # times the median, which a jump of noise stays below
    eps_ratio: float = 8.0  # of eps that are looked at, over 9 decades
    greater: int = 2  # such steps up from eps, to 64 eps
    less: int = 8  # down, to eps/8^8
    # 1/sqrt(eps) grows by 2.8 in such a step, log(eps) by 1.8 at most from eps = 0.01 on.
    # What settles down somewhere, as 1/(eps + 1e-4), is bounded, if large.
    grows: float = 2.5
    felt: float = 1e-9  # of the range of W': of less than that no force knows

    # What l - Phi'(z) loses on slides, where it is rho (`principle`, `contact`).
    slack: float = 1e-10  # of the interval; rounding at |l| = 1e4 rho is 1e-12
    spacings: int = 8  # of l: two each of l, z and Phi', and of what z is solved from

    # Sums of potentials (`summed_series.py`). A series of 511 harmonics for all: a lane
    # took more than 100 s to where it takes 1 in pieces, r = 0.02, eps = 0.01.
    sum_places: int = 1024  # samples a period of one tip's energy
    sum_negligible: float = 1e-15  # of the largest harmonic: what is left out
    sum_harmonics: int = 64  # of a series that tables hold
    sum_beyond: float = 1e-9  # of the largest force: the upper half of all harmonics
    sum_far: float = 1e-6  # the same, of what no table holds
    sum_finer: tuple[int, ...] = (4096, 16384)  # samples, where harmonics go on
    sum_at_rest: float = 1e-30  # m, of eps -> 0, as bristles reach that far
    sum_left: float = 1e-9  # of the sum of all forces: less is rounding, times 1e6

    # Potentials and strips (`potentials.py`, `strip.py`).
    zoom: int = 256  # samples between two neighbours of a scan: its minimum to 1e-8
    # Times that are gone through at once: rooms from the first on, by fours.
    times: int = 256
    most_times: int = 4096


SETTINGS = Settings()
