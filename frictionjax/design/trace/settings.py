"""What traces are taken for, how surfaces are fitted to them, and when: with what lost."""

from typing import NamedTuple


class Settings(NamedTuple):
    """Deviations in standard ones, distances of z in eps, unless said otherwise."""

    # Samples that contradict their neighbours (`outliers.py`).
    # Scatters of all samples, and of those around: in slips neighbours differ.
    scatters: float = 8.0
    around: int = 10  # samples to either side
    beyond_others: float = 0.5  # of the range of all others, beyond it

    # Energy over wells (`energy.py`).
    # Samples in a way of whole wells, or more. With 8, kN for N was not seen any more.
    samples: int = 2
    starts_of_ways: int = 2000
    spike: float = 8.0  # scatters
    few: float = 0.02  # of the samples: fewer ways that gain energy are outliers

    # What is odd (`oddities.py`).
    # Of the work on ways over wells. 0.0000 in 132 traces without noise (nine scenes, three
    # gamma, 30 to 600 samples); kN for N is 0.03 to 0.15 where a load turns, a sign 0.8 to
    # 1.
    gained: float = 0.01
    explained: float = 3.0  # scatters: what noise may gain on a way
    mended: float = 0.02  # gained by a trace in the right unit, noise and all
    rough: float = 0.5  # scatter of neighbours
    roughest: float = 1.5  # two slips a sample reach 1.1
    blind: float = 0.1  # a known error of z that hides where in its well a tip is
    # Times the noise, which the force has to exceed (root mean square).
    drowned: float = 1.5
    sure: float = 6.0
    still: float = 0.02  # of z that is constant, at most
    follows: float = 0.5  # correlation of z and force in a well: 1 without noise
    too_large: float = 3.0  # times the force that the load can build up

    # Where the tip has passed (`passed.py`).
    apart: float = 1 / 24  # between two places of a way
    shorter: float = 4.0  # ways are, at both ends
    most_places: int = 4096

    # Where uncertainties are not known: times the noise that they were known of, from which
    # on they are looked for again, and how often (`fit.py`).
    louder: float = 1.5
    again: int = 2

    # Problems (`problem.py`).
    # Of the force range: the start explains forces no better, or folds appear where the
    # trace does not look (at 0 the first trial without noise began with 386 of 401 samples
    # in other wells).
    start_rough: float = 0.01
    # Prior: bending energy over that of a sine with the range of slopes seen.
    bent: float = 0.5
    room_of_times: int = 64  # by fours: few different programs
    together: int = 256  # samples of one compiled call
    # Of surfaces that the contact sets no bound: periods, which no bristle goes over.
    highest: float = 1.0
    stretch: float = 0.02  # smallest G of an iterate
    times: int = 1024  # at which the fastest slide is looked for
    no_force: float = 1e-6  # of alpha: the least half range of forces

    # Starts (`start.py`, `fit.py`).
    rounds: int = 12
    settled: float = 1e-3
    half_at: float = 3.0  # robust deviations at which a sample counts half
    # Sizes of the prior, of starts that passages bound, and of one that they do not. Of 10
    # surfaces at 3e-4 N the bounded ones do for 9, and the last for the one left over.
    priors: tuple[float, ...] = (10.0, 1.0, 0.1, 0.01)
    unbounded_prior: float = 0.01
    spread: float = 0.3  # of coefficients, of starts drawn at random
    tries: int = 10_000  # of which some are admissible
    # Steps of all trajectories, some 10 s: once they were taken no other descent is begun.
    # With three times the steps a trajectory, fits that needed 6 descents took 1.6e6, and
    # failing ones went on to 27e6, three minutes.
    work: int = 1_500_000

    # Descents (`gauss_newton.py`).
    fast: float = 10.0  # sliding speeds: half a percent of a slip period moves z by 0.05
    well: float = 0.25  # samples further off are in another well
    linear: float = 3.0  # robust deviations from which on residuals count linearly
    # Samples are first taken to be as rough as this, then less and less so. At once as good
    # as they are, sharp bends fit some slips, and 2 of the first 3 trials ended there.
    blurs: tuple[float, ...] = (0.1, 0.03, 0.01, 0.003, 0.0)
    # Decreases of the objective that end each of them.
    enough: tuple[float, ...] = (1.0, 1.0, 1.0, 1.0, 1e-2)
    held: float = 0.01  # of the range of forces
    patience: int = 6  # steps without a better objective: weights change back and forth
    damping: float = 1e-3  # Marquardt's at first, and its ends
    most_damping: float = 1e4
    least_damping: float = 1e-9

    # What is determined (`weights.py`).
    phases: int = 256
    unseen: float = 1e-14  # of the largest squared singular value: no direction below
    # Of a bump's width, either way: dips of the error narrower than this are the work of
    # first derivatives. A fold that slips time is known 10 times as well as what is beside
    # it, but where it is moves with that: 1 of 10 fits was 6 standard errors off there.
    dip: float = 0.25
    reach: float = 0.5  # widths: bumps this near to a phase are steep there
    # Of the size of coefficients: how well a direction is known that is seen.
    seen: float = 0.1

    # Reports (`report.py`).
    # Both: deviations of chi2, and times what is expected, which small errors of eps, gamma
    # or the stiffness may add at thousands of samples.
    sigmas: float = 5.0
    too_much: float = 1.5
    doubtful: float = 3.0  # deviations of chi2 from which on other starts are tried
    # Of the samples may be in other wells, as outliers: at 1% an optimum with one of 201
    # there passed, its slopes 23 standard errors off.
    disputed: float = 0.002
    misfit: float = 0.2  # of the samples, there: no slips at other times alone
    no_phase: float = 0.1  # residuals of unknown uncertainty larger than that show none
    little: float = 0.05  # of the period


SETTINGS = Settings()
