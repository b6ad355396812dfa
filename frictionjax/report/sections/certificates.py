"""What a sweep proves of its own values, cell by cell."""

from typing import TYPE_CHECKING

import numpy as np

from ..._text import ResultTable
from ...studies import flag_names, formatted

if TYPE_CHECKING:
    import xarray as xr

_HEADER = (
    "gamma",
    "eps/m",
    "from every slip",
    "by brackets",
    "by slip map",
    "widest bracket/eps",
    "sampled",
    "residual/J",
    "residual/dissipated",
    "status",
)


def certificate_rows(data: "xr.Dataset") -> ResultTable | None:
    """One line a cell: how many values were found which way, how near bounds have come,
    the residual of the energy balance, status.

    None for a data set of another solver's, which bounds nothing.
    """
    if "how" not in data and "residual" not in data:
        return None
    names = flag_names(data.status)
    rows = [
        _row(data.sel(gamma=gamma, eps=eps), float(gamma), float(eps), names)
        for gamma in data.gamma.values
        for eps in data.eps.values
    ]
    return ResultTable(_HEADER, tuple(rows), left=0)


def _row(
    cell: "xr.Dataset", gamma: float, eps: float, names: dict[int, str]
) -> tuple[str, ...]:
    return (
        f"{gamma:.4g}",
        f"{eps:.4g}",
        *_ways(cell),
        formatted(_widest(cell)),
        formatted(_number(cell, "sampled")),
        formatted(_number(cell, "residual")),
        formatted(_share(cell)),
        names[int(cell.status)],
    )


def _ways(cell: "xr.Dataset") -> tuple[str, ...]:
    """Values in time by how each was obtained."""
    if "how" not in cell:
        return ("-",) * 3
    how = _over_time(cell, "how")
    return tuple(str(int(np.sum(how == way))) for way in range(3))


def _widest(cell: "xr.Dataset") -> float:
    """Of the brackets that values were read from, in eps."""
    if "bracket" not in cell or "how" not in cell:
        return float("nan")
    used = _over_time(cell, "bracket")[_over_time(cell, "how") == 1]
    used = used[np.isfinite(used)]
    return float(used.max()) if used.size else float("nan")


def _over_time(cell: "xr.Dataset", name: str) -> np.ndarray:
    """At every time kept, also of what is the same at all of them."""
    return np.atleast_1d(cell[name].broadcast_like(cell.z).values)


def _share(cell: "xr.Dataset") -> float:
    """The residual over all that was dissipated."""
    if "dissipation" not in cell:
        return float("nan")
    spent = float(np.atleast_1d(cell.dissipation.values)[-1])
    return _number(cell, "residual") / spent if spent > 0 else float("nan")


def _number(cell: "xr.Dataset", name: str) -> float:
    return float(cell[name]) if name in cell else float("nan")
