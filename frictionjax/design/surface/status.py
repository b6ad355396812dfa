"""How the fit of a profile ended."""

from ..._checks import Outcome


class ProfileStatus(Outcome):
    """Why a fit did or did not meet its targets; `message` says it for people."""

    MET = 0, "every target is met"
    WITHIN_UNCERTAINTY = 1, "targets differ by no more than their uncertainties explain"
    CONTRADICTORY = 2, "targets contradict each other: the best weighted compromise"
    INADMISSIBLE = 3, "not reachable with slopes that the bristle can follow"
    TOO_FEW_HARMONICS = 4, "not reachable with this number of harmonics"
    TOO_SHARP = 5, "not reachable with curvatures of at least smallest_radius"
    TOO_HIGH = 6, "not reachable with heights within largest_amplitude"
    OUT_OF_BOUNDS = 7, "not reachable with free parameters inside their bounds"
    MAX_STEPS = 8, "the step budget ran out before the optimum; raise max_steps"
    NOT_FINITE = 9, "the fit left the range of finite numbers"
    NO_SLIDE = 10, "a design whose steady slide was not found"
    NOT_SETTLED = 11, "designs and their slides did not settle"
    NOT_FOUND = 12, "not found, though nothing here says that it is out of reach"


MET = (ProfileStatus.MET, ProfileStatus.WITHIN_UNCERTAINTY)
"""The statuses of a success."""
