"""How the fit to a trace ended."""

from ..._checks import Outcome


class TraceStatus(Outcome):
    """Why a fit to a trace can or cannot be trusted; `message` says it for people."""

    FITTED = 0, "the surface explains the trace"
    NO_SLIDE = 1, "the tip never leaves its first well: most of the surface is not seen"
    UNDETERMINED = 2, "the trace determines too little of the surface"
    MISFIT = 3, "residuals that errors do not explain: another scene, or more starts needed"
    OTHER_SLIPS = (
        4,
        "slips come at other times than in the trace: the fit did not find the surface "
        "(more starts may), or another scene",
    )
    MAX_STEPS = 5, "the step budget ran out before the optimum; raise max_steps"
    NOT_FINITE = 6, "the start has no trajectory: slips too short, or too many"
    WRONG_SCALE = 7, "the trace looks to be in another unit"
    WRONG_SIGN = 8, "the trace looks to have the other sign"
    NOISE = 9, "noise hides what the surface does"
    IMPOSSIBLE = 10, "no surface gives this trace in this scene"
    OUTLIERS = 11, "some samples contradict all others"
