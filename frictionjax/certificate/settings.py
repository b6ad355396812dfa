"""What tells solutions from other curves: measured, with what lost.

At eps 1e-3 to 0.3, gamma 0.5 to 2 and every bristle, true curves with and without noise of
eps/100 against wrong ones: shifted by eps/10, a well skipped, another gamma. With mass: at
eps 1e-3 to 1e-2, gamma 0.5 to 2 and beta 1e-3 to 300, those, half and twice the mass, and
velocities off by a tenth.
"""

from typing import NamedTuple


class Settings(NamedTuple):
    """Lengths in units of eps, and places in periods, unless said otherwise."""

    # Verdicts.
    coarsest: float = 0.25  # between two samples: more, and slips are not resolved
    # Noise 0.0105 (0.018 where rests are sampled thinly), shift 0.07.
    farthest: float = 0.03
    # Of Phi'' eps at a fold: noise -0.013 and less, skipped wells 0.16 to 0.8, or
    # anything below where the load overshoots by a well while a fold is passed: there
    # distance tells.
    missing_force: float = 0.02
    # Relative: noise 0.02; a gamma off by 0.1 is 0.13 at eps = 0.3 and grows below.
    viscosity: float = 0.1
    coarser: float = 0.1  # of what it is off by: from half the samples as far from that

    # Passages.
    around_fold: float = 0.015  # noise of eps/100 makes no passage
    around_fastest: float = 0.25  # of the fastest place of a slip: what counts as the slip
    # Noise of one eps at all samples inside a slip may change its viscosity by so much of
    # it: 5 to 15 in slips, 30 to 1e6 where a tip lingers.
    swayed: float = 20.0

    # Distance.
    second_order: float = 0.015  # perturbation up to which the second order is allowed for
    places_of_bend: int = 513  # of a well: how much the force bends there
    surely: float = 0.06  # at most so far from a solution: no more is asked
    sliding: float = 0.3  # of (rho_plus - rho_minus)/2: larger forces are a slide's

    # Curves between samples.
    stiff: float = 1.5  # relaxation times an interval: beyond, velocities are not slopes
    # Samples a compiled call: any curve runs in the same program. (2^14: 600 samples took
    # four times as long.)
    chunk: int = 1 << 11

    # Curves with mass; in periods, and speeds in units. Shooting from samples in place of
    # stages near them lost: curves shifted by eps/100 ran away at folds.
    steps: int = 2048  # of one compiled call
    # Half as long steps may change the way between samples by that. 1e-4: in doubt by
    # 0.017 at beta = 300, where what is missed is not forgotten.
    local: float = 1e-6
    most: int = 256  # steps between two samples
    room: int = 1 << 14  # steps in all gaps that need so many: of a wrong curve all do
    room_a_gap: int = 6  # and more of longer curves; without, 86 s for a velocity of 0
    swing: float = 0.2  # of the guess between samples that hardly move
    trusted: float = 0.2  # the longest move of one iteration
    rounds: int = 40  # of Newton's method
    solved: float = 1e-5  # changes at which it ends: rounding leaves 1e-6 at weak damping
    rounds_in_gaps: int = 10  # in each gap alone, from where all of them set off
    hopeless: float = 0.5  # moved that far: there is none nearby
    unsure: float = 0.01  # doubt about it

    # Rods that turn over.
    turned: float = 3e-3  # of the critical load: by so much they may be early or late
    places: int = 1024  # of one compiled call: a period is looked at there
    approach: float = 0.1  # periods from which tips come to a place
    approaching: int = 65  # steps on that way
    zooms: int = 4  # each by so many, into where a compression is the critical load
    aside: float = 0.01  # of a gap, from its ends: where in it a mode may change


SETTINGS = Settings()
