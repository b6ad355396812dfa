"""What a study has found, in sentences: its verdict, its pictures."""

import numpy as np
import xarray as xr

from ..coefficients import Coefficients
from ..convergence import Verdict
from ..studies import Study
from .sections import friction_sentence, under_condition

_NOTHING = {
    Verdict.DIVERGES: "the errors grow as eps falls",
    Verdict.UNDECIDED: "the interval holds 0, which decides nothing",
    Verdict.TOO_FEW_POINTS: "too few cells are left to measure an order",
    Verdict.NO_POWER: "the errors follow no power of eps",
}


def verdict_sentence(found: Study, law: Coefficients) -> str:
    """The order beside the predicted one, friction, and how many cells failed.

    `law`: of the scene's slides.
    """
    count, failed = found.dataset.status.size, len(found.failed)
    told = f"{failed} of {count} computations failed" if failed else _none_failed(count)
    if found.spread is not None:
        return f"{_over_rows(found)} {told}."
    line = _nearest(found.orders)
    known = Verdict(int(line.verdict)) not in _NOTHING
    meant = f" {_halved(float(line.order))}" if known else ""
    friction = friction_sentence(law, _massless(line))
    return f"{_order_sentence(line)}{meant} {told}. {friction}"


def _massless(line: xr.Dataset) -> str:
    """Where mass does not fall fast enough with eps friction need not come to rho."""
    return "" if int(line.get("overdamped", 1)) else " without inertia"


def _none_failed(count: int) -> str:
    return f"None of the {count} computations failed"


def _nearest(orders: xr.Dataset) -> xr.Dataset:
    """Of the gamma that is nearest to 1."""
    return orders.isel(gamma=int(np.argmin(np.abs(orders.gamma.values - 1.0))))


def _order_sentence(line: xr.Dataset, prefix: str = "", what: str = "The motion") -> str:
    gamma, verdict = float(line.gamma), Verdict(int(line[f"{prefix}verdict"]))
    if verdict in _NOTHING:
        return f"{what} at gamma = {gamma:.4g}: {_NOTHING[verdict]}."
    order, low, high = (float(line[f"{prefix}order{end}"]) for end in ("", "_low", "_high"))
    told = (
        f"{what} comes to that of dry friction like eps^{order:.3f} (gamma = {gamma:.4g}, "
        f"95% interval {low:.3f} to {high:.3f})"
    )
    predicted = float(line.get(f"{prefix}order_predicted", np.nan))
    if np.isfinite(predicted):
        where = "inside" if low <= predicted <= high else "outside"
        told += f"; theory predicts {predicted:.4g}, which lies {where} that interval"
    if verdict == Verdict.NOT_YET_SEEN:
        told += ", but these eps do not show that power yet"
    return f"{told}."


def _halved(order: float) -> str:
    """What an order means for bumps of half the distance."""
    return f"Bumps at half the distance leave {2.0**-order:.2g} of the difference."


def _over_rows(found: Study) -> str:
    assert found.spread is not None
    at = _nearest(found.spread)
    if not int(at.scenes):
        few = _NOTHING[Verdict.TOO_FEW_POINTS]
        return f"At gamma = {float(at.gamma):.4g}, in none of the rows of the map: {few}."
    low, middle, high = (float(at["order"].sel(quantile=q)) for q in (0.05, 0.5, 0.95))
    return (
        f"Over {int(at.scenes)} rows of the map the motion comes to that of dry friction "
        f"like eps^{middle:.3f} in the median row, and between eps^{low:.3f} and "
        f"eps^{high:.3f} in 90% of them (gamma = {float(at.gamma):.4g})."
    )


_SIGNS = (
    "Filled points are in the window of the fit, hollow ones are left out; solid: what was "
    "fitted; dashed: the law of theory"
)
_CAPTIONS = {
    "trajectories": (
        "The state over time for a large, a middle and a small eps. The dashed line is "
        "the limit, dry friction; the shaded strip holds all states at which friction "
        "can hold the bristle."
    ),
    "close trajectories": (
        "Right: a few slips from hollow to hollow, framed on the left. Dots stand for an "
        "eps whose slips the stored times are too few to follow."
    ),
    "loop": (
        "The friction force against the state, once to and fro. The smaller eps, the "
        "nearer the loop is to the two levels of dry friction. Dots stand for an eps whose "
        "slips the stored times are too few to follow."
    ),
    "dissipation": "The energy that has become heat. The dashed line is the limit's.",
    "turning": "How the rod turns over: before, bent over its tip, and after.",
    "nap_loops": "Force against place with both effects of the nap, in the limit.",
    "sup_error": (
        f"Largest distance of the state from the limit. {_SIGNS}; dotted in grey: slope of "
        "the proven bounds."
    ),
    "dissipation_error": (
        f"Largest distance of the dissipated energy from the limit's. {_SIGNS}."
    ),
    "strip_excess": (
        f"How far the state goes beyond the strip, at most; the limit never does. {_SIGNS}."
    ),
    "rows": (
        "Left: largest distance of the state from the limit against eps, median of the "
        "rows and a band that holds 90% of them. Right: the order of each row, a line at "
        "the median; crosses are what the law of theory says."
    ),
    "convergence": (
        "Largest distances from the limit against eps. Of scenes with jumps, distances of "
        "graphs with jumps filled."
    ),
}
_PREFIXES = {"sup_error": "", "dissipation_error": "dissipation_", "strip_excess": "strip_"}
_UNITS = {"sup_error": "m", "dissipation_error": "J", "strip_excess": "m"}
_WHAT = {
    "sup_error": "distance of the state from the limit",
    "dissipation_error": "distance of the dissipated energy from the limit's",
    "strip_excess": "distance of the state from the strip",
}


def picture_of(
    name: str, found: Study, law: Coefficients, gamma: float, panels: int = 1
) -> tuple[str, str]:
    """What a picture tells, with its numbers, and how to read it, its `panels` all."""
    data = found.dataset
    if found.spread is not None:
        return _over_rows(found), _CAPTIONS["rows"]
    if name in _WHAT:
        return _errors_told(found, name), _CAPTIONS[name]
    if name == "trajectories":
        told = _trajectories_told(data, gamma)
        if panels > 1:
            return told, f"{_CAPTIONS[name]} {_CAPTIONS['close trajectories']}"
    elif name == "dissipation":
        told = _dissipation_told(data, gamma)
    elif name == "loop":
        told = (
            f"Loop of friction force against state at gamma = {gamma:.4g}. The limit holds "
            f"{float(law.rho_plus):.4g} N on the way to the right and "
            f"{float(law.rho_minus):.4g} N on the way to the left{under_condition(law)}. "
            f"{_smallest_told(data, gamma)}"
        )
    elif name == "convergence":
        told = " ".join(_errors_told(found, n) for n in _WHAT if n in data)
    else:
        told = str(found.orders.attrs.get("turning", _CAPTIONS[name]))
    return told, _CAPTIONS[name]


def _good(data: xr.Dataset, gamma: float) -> xr.Dataset:
    """Cells of one gamma that can be trusted, the largest eps first."""
    cells = data.sel(gamma=gamma)
    return cells.isel(eps=np.flatnonzero(cells.status.values == 0)).sortby(
        "eps", ascending=False
    )


def _smallest_told(data: xr.Dataset, gamma: float) -> str:
    cells = _good(data, gamma)
    if not cells.eps.size:
        return "No cell of this gamma can be trusted."
    coarse, fine = cells.isel(eps=0), cells.isel(eps=-1)
    return (
        f"The state is up to {float(coarse.sup_error):.3g} m off the limit at eps = "
        f"{float(coarse.eps):.3g} m, and up to {float(fine.sup_error):.3g} m at eps = "
        f"{float(fine.eps):.3g} m."
    )


def _trajectories_told(data: xr.Dataset, gamma: float) -> str:
    limit = data.z_limit.values
    return (
        f"State over time at gamma = {gamma:.4g}. In {float(data.time[-1]):.4g} s the "
        f"limit moves between {np.min(limit):.4g} and {np.max(limit):.4g} m. "
        f"{_smallest_told(data, gamma)}"
    )


def _dissipation_told(data: xr.Dataset, gamma: float) -> str:
    cells = _good(data, gamma)
    told = (
        f"Dissipated energy over time at gamma = {gamma:.4g}. In the limit "
        f"{float(data.dissipation_limit[-1]):.4g} J become heat in "
        f"{float(data.time[-1]):.4g} s"
    )
    for place in (0, -1) if cells.eps.size else ():
        cell = cells.isel(eps=place)
        told += f", {float(cell.dissipation[-1]):.4g} J at eps = {float(cell.eps):.3g} m"
    return f"{told}."


def _errors_told(found: Study, name: str) -> str:
    lines = [f"Errors against eps, both on logarithmic scales: {_WHAT[name]}."]
    for gamma in found.dataset.gamma.values:
        cells = _good(found.dataset, gamma)
        if not cells.eps.size:
            lines.append(f"gamma = {gamma:.4g}: no cell can be trusted.")
            continue
        ends = [
            f"{float(cells[name][place]):.3g} {_UNITS[name]} at eps = "
            f"{float(cells.eps[place]):.3g} m"
            for place in (0, -1)
        ]
        lines.append(f"gamma = {gamma:.4g}: from {ends[0]} to {ends[1]}.")
        line = found.orders.sel(gamma=gamma)
        if f"{_PREFIXES[name]}order" in line:
            lines.append(_order_sentence(line, _PREFIXES[name], "This error"))
    return " ".join(lines)
