"""What a study has found, as tables: cells, orders, constants, failures."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from .._text import ResultTable

_GRAPHS = (
    ("graph_error", "graph error/m"),
    ("dissipation_graph_error", "graph error/J"),
)


def sweep_table(dataset: xr.Dataset) -> ResultTable:
    """One line a cell: errors, residual, steps, status."""
    names = flag_names(dataset.status)
    graphs = [column for column in _GRAPHS if column[0] in dataset]
    rows = []
    for gamma in dataset.gamma.values:
        for eps in dataset.eps.values:
            cell = dataset.sel(gamma=gamma, eps=eps)
            error = float(cell.sup_error)
            rows.append(
                (
                    f"{gamma:.4g}",
                    f"{eps:.4g}",
                    formatted(error),
                    formatted(error / eps),
                    *(formatted(float(cell[name])) for name, _ in graphs),
                    formatted(_value(cell, "dissipation_error")),
                    formatted(_value(cell, "residual")),
                    f"{int(cell.steps)}",
                    names[int(cell.status)],
                )
            )
    header = (
        "gamma",
        "eps/m",
        "sup error/m",
        "in eps",
        *(title for _, title in graphs),
        "dissipation error/J",
        "residual/J",
        "steps",
        "status",
    )
    return ResultTable(header, tuple(rows), left=0)


_ERRORS = (
    ("", "state"),
    ("dissipation_", "dissipation"),
    ("strip_", "from the strip"),
    ("graph_", "graph of the state"),
    ("dissipation_graph_", "graph of the dissipation"),
)


def order_table(orders: xr.Dataset) -> ResultTable:
    """One line for each error and gamma: order, what the law predicts, window, verdict.

    `order` and `constant` are for eps -> 0, `seen` is the slope of the errors themselves.
    """
    rows = [
        (name, f"{gamma:.4g}", *_order_cells(orders, orders.sel(gamma=gamma), prefix))
        for prefix, name in _ERRORS
        if f"{prefix}order" in orders
        for gamma in orders.gamma.values
    ]
    header = (
        "error",
        "gamma",
        "order [95%]",
        "predicted",
        "law",
        "seen",
        "constant [95%]",
        "predicted",
        "eps window/m",
        "points",
        "verdict",
    )
    return ResultTable(header, tuple(rows), left=1)


def _order_cells(orders: xr.Dataset, line: xr.Dataset, prefix: str) -> tuple[str, ...]:
    return (
        _interval(line, prefix),
        _plain(_value(line, f"{prefix}order_predicted")),
        str(line[f"{prefix}law"].item()),
        _slope(_value(line, f"{prefix}order_seen")),
        _constant(line, prefix),
        formatted(_value(line, f"{prefix}constant_predicted")),
        _window(line, prefix),
        f"{int(line[f'{prefix}points'])}",
        _verdict(orders, line, prefix),
    )


def spread_table(spread: xr.Dataset) -> ResultTable:
    """One line for each error and gamma: median and 90% of orders and constants."""
    rows = [
        (
            name,
            f"{gamma:.4g}",
            _ranged(spread[f"{prefix}order"].sel(gamma=gamma), "{:.3f}"),
            *_predicted_cells(spread.sel(gamma=gamma), prefix),
            _ranged(spread[f"{prefix}constant"].sel(gamma=gamma), "{:.3g}"),
            f"{int(spread.scenes.sel(gamma=gamma))}",
        )
        for prefix, name in _ERRORS
        if f"{prefix}order" in spread
        for gamma in spread.gamma.values
    ]
    header = ("error", "gamma", "order [5%, 95%]", "predicted", "in", "constant", "rows")
    note = (
        "(Median, and between which values 90% of the rows lie. Orders and constants of\n"
        "each row are for eps -> 0, by its law where its errors follow one. in: how many\n"
        "of the rows the law predicts an order of; of the others, free, it says none.)"
    )
    return ResultTable(header, tuple(rows), left=1, note=note)


def _predicted_cells(spread: xr.Dataset, prefix: str) -> tuple[str, str]:
    """Of one gamma: what laws predict, and in how many rows."""
    count = int(spread[f"{prefix}predicted_scenes"])
    return _ranged(spread[f"{prefix}order_predicted"], "{:.3f}"), f"{count}"


def _ranged(quantiles: xr.DataArray, form: str) -> str:
    """Median and 90%, or a dash where no row has a number."""
    values = [float(quantiles.sel(quantile=q)) for q in (0.05, 0.5, 0.95)]
    if not np.all(np.isfinite(values)):
        return "-"
    low, middle, high = map(form.format, values)
    return f"{middle} [{low}, {high}]"


def lemma_table(orders: xr.Dataset) -> ResultTable:
    """One line a gamma: the lemmas' exponent, and their constants as measured."""
    rows = []
    for gamma in orders.gamma.values:
        line = orders.sel(gamma=gamma)
        constants = formatted(float(line.C0)), formatted(float(line.C))
        beta = float(line.beta)
        unit = "" if beta == 1 else f"m^{1 - beta:.3g}"
        rows.append((f"{gamma:.4g}", f"{beta:.3g}", constants[0], unit, constants[1]))
    header = ("gamma", "beta", "C0 of Lemma 7", "unit", "C of Lemma 9")
    note = "(C: in m/s before |t - s|, in the unit of C0 before eps^beta)"
    return ResultTable(header, tuple(rows), note=note, left=0)


def failed_table(failed: Sequence[dict[str, Any]]) -> str:
    """One line a failed cell with the reason; says so where none failed."""
    return str(failures(failed)) if failed else "no cell failed"


def failures(failed: Sequence[dict[str, Any]]) -> ResultTable:
    """One line a failed cell with the reason."""
    several = bool(failed) and "scene" in failed[0]
    rows = [
        (
            *((str(cell["scene"]),) if several else ()),
            f"{cell['gamma']:.4g}",
            f"{cell['eps']:.4g}",
            cell["status"],
            cell["message"],
        )
        for cell in failed
    ]
    scene = ("scene",) if several else ()
    header = (*scene, "gamma", "eps/m", "status", "why")
    return ResultTable(header, tuple(rows), left=1, meanings=1)


def flag_names(variable: xr.DataArray) -> dict[int, str]:
    """Names of the integers of a CF flag variable."""
    values = np.atleast_1d(variable.attrs["flag_values"])
    names = variable.attrs["flag_meanings"].split()
    return {int(value): name for value, name in zip(values, names, strict=True)}


def _verdict(orders: xr.Dataset, line: xr.Dataset, prefix: str) -> str:
    name = f"{prefix}verdict"
    return flag_names(orders[name])[int(line[name])].replace("_", " ")


def _value(cell: xr.Dataset, name: str) -> float:
    return float(cell[name]) if name in cell else float("nan")


def formatted(value: float) -> str:
    """Three digits, or a dash where there is no number."""
    return f"{value:.3g}" if np.isfinite(value) else "-"


def _interval(line: xr.Dataset, prefix: str) -> str:
    order = _value(line, prefix + "order")
    if not np.isfinite(order):
        return "-"
    low, high = (_value(line, f"{prefix}order_{end}") for end in ("low", "high"))
    return f"{order:.3f} [{low:.3f}, {high:.3f}]"


def _constant(line: xr.Dataset, prefix: str) -> str:
    names = (f"{prefix}constant", f"{prefix}constant_low", f"{prefix}constant_high")
    constant, low, high = (formatted(_value(line, name)) for name in names)
    return constant if low == "-" else f"{constant} [{low}, {high}]"


def _slope(order: float) -> str:
    return f"{order:.3f}" if np.isfinite(order) else "-"


def _window(line: xr.Dataset, prefix: str) -> str:
    low, high = float(line[f"{prefix}eps_min"]), float(line[f"{prefix}eps_max"])
    return f"{low:.3g} to {high:.3g}" if np.isfinite(low) else "-"


def _plain(order: float) -> str:
    return f"{order:.4g}" if np.isfinite(order) else "-"
