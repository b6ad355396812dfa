"""Which method and accuracy to take, in one sentence, by what was measured."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from ..wiggly import Status
from .settings import SETTINGS

_SAME = 1.1  # ratio of times that a second run may turn round


class _Choice(NamedTuple):
    """A method at an accuracy in all cells: `error` in eps, `seconds` of all together."""

    method: str
    accuracy: float
    error: float
    seconds: float


def advice(data: xr.Dataset) -> str:
    """What to take for errors within 1e-3 eps, of the runs of `work_precision`.

    Candidates were asked for no less, ended OK in every cell and came within it there, by a
    reference that can tell. The fastest is named, of ties the method that stands first, and
    by how much the next one is slower. Where the accuracies are all looser, the tightest of
    them is what is wanted. At the end those who reported success and were wrong, and those
    that there was no time for.
    """
    asked = data.accuracy.values
    close = asked <= SETTINGS.wanted
    wanted = float(asked[close].max() if close.any() else asked.min())
    choices = sorted(_choices(data, wanted), key=lambda one: one.seconds)
    cells = data.sizes["gamma"] * data.sizes["eps"]
    where = f"in all {cells} cells" if cells > 1 else "in the cell"
    if not choices:
        start = f"No method was measured to keep {wanted:.0e} eps {where}"
    else:
        best = _first_of_ties(choices, data.solver.values.tolist())
        start = (
            f"For {wanted:.0e} eps take method={best.method!r}, "
            f"accuracy={best.accuracy:.0e}: z within {best.error:.1e} eps {where} "
            f"in {best.seconds:.2g} s"
        )
        others = [one for one in choices if one.method != best.method]
        if others:
            ratio = others[0].seconds / best.seconds
            times = f"{ratio:.2g} times as long" if ratio >= _SAME else "as long"
            start += f", the next method, {others[0].method!r}, takes {times}"
    return f"{start}{_wrong(data)}{_untried(data)}."


def _first_of_ties(choices: list[_Choice], order: list[str]) -> _Choice:
    """Of those that are about as fast as the fastest, the first in the order asked for."""
    ties = [one for one in choices if one.seconds < _SAME * choices[0].seconds]
    return min(ties, key=lambda one: (order.index(one.method), -one.accuracy))


def _choices(data: xr.Dataset, wanted: float) -> list[_Choice]:
    found = []
    for accuracy in data.accuracy.values[data.accuracy.values <= wanted]:
        for name in data.solver.values:
            run = data.sel(solver=name, accuracy=accuracy)
            # What the reference cannot tell is no better than the reference.
            error = float(np.maximum(run.error, data.reference_error).max(skipna=False))
            if np.all(run.status == Status.OK) and error <= wanted:
                seconds = float(run.seconds.sum())
                found.append(_Choice(str(name), float(accuracy), error, seconds))
    return found


def _wrong(data: xr.Dataset) -> str:
    wrong = data.wrong.sum(["gamma", "eps", "accuracy"])
    names = [str(name) for name in data.solver.values[wrong.values > 0]]
    return (
        f"; success reported half an eps or more off: {', '.join(names)}" if names else ""
    )


def _untried(data: xr.Dataset) -> str:
    """Who was not even asked for the loosest accuracy, nowhere or not in every cell."""
    loosest = data.status.isel(accuracy=int(data.accuracy.values.argmax()))
    missing = (loosest == Status.NOT_TRIED).sum(["gamma", "eps"]).values
    cells = data.sizes["gamma"] * data.sizes["eps"]
    names = [str(name) for name in data.solver.values]
    never = [name for name, n in zip(names, missing, strict=True) if n == cells]
    some = [name for name, n in zip(names, missing, strict=True) if 0 < n < cells]
    told = ", ".join(never + [f"{name} (in some cells)" for name in some])
    return f"; not run, for want of time: {told}" if told else ""
