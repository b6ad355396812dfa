"""How a computation ended."""

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from ..._checks import Outcome
from .settings import SETTINGS


class Status(Outcome):
    """Why a result can or cannot be trusted; `message` says it for people.

    >>> fx.Status(7)
    <Status.OPEN_BRACKET: 7>
    >>> fx.Status(7).message
    'starts are not forgotten, and every slip is too many to integrate'
    """

    OK = 0, "every number can be trusted"
    MAX_STEPS = 1, "the step budget ran out before the last time; raise max_steps"
    STEP_TOO_SMALL = 2, "steps would have to be shorter than the spacing of floats at t"
    NOT_FINITE = 3, "the trajectory is not finite, or traced numbers are out of range"
    SOLVER_FAILED = 4, "the solver gave up on a step"
    UNBALANCED = 5, "the energy-dissipation balance does not close"
    TOO_MANY_TURNS = 6, "the load turns more often than the scene has room for"
    OPEN_BRACKET = 7, "starts are not forgotten, and every slip is too many to integrate"
    ROUGH_SURVEY = 8, "a slide changes too fast to be known from some of its slips"
    TOO_SLOW = 9, "the run was ended at the seconds allowed"
    NOT_TRIED = 10, "not run: too slow at a looser accuracy, or no time was left"
    SENSITIVE = 11, "which well a slip ends in hangs on errors that no step size removes"


# How runs end that have come to their end.
ENDED = (Status.OK, Status.UNBALANCED, Status.ROUGH_SURVEY)


class FailedCells(UserWarning):
    """Some cells of a data set have numbers that cannot be trusted, or none."""


def warn_of_failed(
    codes: Int[np.ndarray, "*scenes g e"],
    gamma: Float[np.ndarray, " g"],
    eps: Float[np.ndarray, " e"],
    scenes: Sequence[Any] = (),
    frames: int = 0,
) -> None:
    """One warning that names the cells (gamma, eps) whose status is not OK.

    `scenes`: labels, where there are several. `frames`: how many lie between the caller
    and the line that it is given for.
    """
    failed = np.argwhere(codes != int(Status.OK)).tolist()
    if not failed:
        return
    named = []
    for *scene, i, j in failed[: SETTINGS.named]:
        of = f"scene {scenes[scene[0]]}, " if scene else ""
        name = Status.of(codes[(*scene, i, j)]).name
        named.append(f"{of}gamma = {gamma[i]:.6g}, eps = {eps[j]:.6g}: {name}")
    more = (
        f" and {len(failed) - SETTINGS.named} more" if len(failed) > SETTINGS.named else ""
    )
    message = Status.of(codes[tuple(failed[0])]).message
    warnings.warn(
        f"{len(failed)} of {codes.size} cells failed ({'; '.join(named)}{more}), the first "
        f"because {message}; see `status`",
        FailedCells,
        stacklevel=3 + frames,
    )
