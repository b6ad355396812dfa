"""Plain-text tables with aligned columns."""

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..bristles import pulling_text
from ..measured import RowCoefficients
from ..model import Coefficients

if TYPE_CHECKING:
    import xarray as xr

_LAW = (
    ("rho_plus", "N", "friction against motion to the right"),
    ("rho_minus", "N", "friction against motion to the left"),
    ("ratio", "", "-rho_plus/rho_minus"),
    ("alpha", "N", "normal force without friction"),
    ("normal_plus", "N", "normal force of a slide to the right"),
    ("normal_minus", "N", "normal force of a slide to the left"),
    ("a", "", "lean of the bristle, A'(0)"),
    ("mu_plus", "", "largest slope that the bristle sees, friction/alpha"),
    ("mu_minus", "", "smallest slope that the bristle sees, friction/alpha"),
    ("omega_plus", "", "largest slope of the surface, friction/normal force"),
    ("omega_minus", "", "smallest slope of the surface, friction/normal force"),
)
_NOISE = (
    "(std: of a single row. Noise adds to the extreme slopes of a row, so the mean over\n"
    "rows lies above the friction of the mean profile, which is the one above.)"
)
_BRISTLE = ("alpha", "a")  # the bristle's own, the same on every surface
# alpha < 0: rho_plus, of a slide to the right, is made by the smallest slope.
_SLOPES = {"omega_plus": "left", "omega_minus": "right"}
_FITTED = ("explained", "", "share of the variance that is periodic")


def table(header: Sequence[str], rows: Iterable[Sequence[str]], left: int = 0) -> str:
    """Columns under a header, set flush right but for the first `left` and the last text.

    Lines carry no trailing blanks.
    """
    cells = [list(header), *(list(row) for row in rows)]
    widths = [max(len(row[i]) for row in cells) for i in range(len(header))]
    lines = []
    for row in cells:
        texts = [
            text.ljust(width) if i < left else text.rjust(width)
            for i, (text, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(texts).rstrip())
    return "\n".join(lines)


def coefficients_by_name(found: Coefficients) -> dict[str, float]:
    """Numbers of a friction law by name, `ratio` = -rho_plus/rho_minus added.

    Only those that exist: the abstract setting has no bristle's.
    """
    left = float(found.rho_minus)
    numbers = {"ratio": -float(found.rho_plus) / left} if left else {}
    for name, _, _ in _LAW:
        value = getattr(found, name, None)
        if value is not None:
            numbers[name] = float(value)
    return {name: numbers[name] for name, _, _ in _LAW if name in numbers}


def errors_by_name(
    found: Coefficients, standard: dict[str, float] | None = None
) -> dict[str, float]:
    """Errors by name, of what samples leave of the surface; empty where nothing is known.

    `standard`: errors over the rows of a map. They see scatter and no corners, the others
    both: the larger one of each is the error.
    """
    known = dict(standard or {})
    if found.omega_plus_error is None:
        return known
    for side in ("plus", "minus"):
        omega, mu = (float(getattr(found, f"{name}_{side}")) for name in ("omega", "mu"))
        of_omega = float(getattr(found, f"omega_{side}_error"))
        known |= _larger(known, f"omega_{side}", of_omega)
        known |= _larger(known, f"mu_{side}", of_omega * (mu / omega) ** 2)
        of_rho = float(getattr(found, f"rho_{side}_error"))
        known |= _larger(known, f"rho_{side}", of_rho)
        known |= _larger(known, f"normal_{side}", abs(float(found.a)) * of_rho)
    parts = (
        float(getattr(found, f"rho_{side}_error")) / float(getattr(found, f"rho_{side}"))
        for side in ("plus", "minus")
    )
    ratio = abs(coefficients_by_name(found)["ratio"])
    return known | _larger(known, "ratio", ratio * math.hypot(*parts))


def _larger(known: dict[str, float], name: str, error: float) -> dict[str, float]:
    return {name: max(known.get(name, 0.0), error)}


def coefficient_table(found: Coefficients, error: dict[str, float] | None = None) -> str:
    """Friction coefficients with their units and meanings, and errors if known.

    `error`: standard errors over the rows of a map, beside those of `errors_by_name`.
    """
    numbers, error = coefficients_by_name(found), errors_by_name(found, error)
    pulls = numbers.get("alpha", 0.0) < 0
    rows = [
        (
            name,
            _signed(numbers[name]),
            *_plus_minus(name, error),
            unit.ljust(4),
            _meaning(name, meaning, pulls),
        )
        for name, unit, meaning in _LAW
        if name in numbers
    ]
    added = ("+-",) if error else ()
    text = _with_meanings(("coefficient", "value", *added, "unit", "meaning"), rows)
    note = pulling_text(numbers.get("alpha", 0.0))
    notes = [note for note in (_taken_text(found), note) if note]
    return "\n".join([text, *(f"({note})" for note in notes)])


def _taken_text(found: Coefficients) -> str:
    """What of the errors of slopes a filter is the cause of; nothing without one."""
    plus, minus = found.omega_plus_taken, found.omega_minus_taken
    if plus is None or minus is None:
        return ""
    plus, minus = float(plus), float(minus)
    return f"+-: of omega_plus {plus:.2g}, of omega_minus {minus:.2g} by smoothing"


def _meaning(name: str, meaning: str, pulls: bool) -> str:
    """What a number means; where a bristle pulls, the normal forces change sides."""
    if not (pulls and name in _SLOPES):
        return meaning
    return f"{meaning} of a slide to the {_SLOPES[name]}"


def _plus_minus(name: str, error: dict[str, float] | None) -> tuple[str, ...]:
    if not error:
        return ()
    known = name in error and name not in _BRISTLE
    return (f"{error[name]:.2g}" if known else "",)


def row_table(rows: RowCoefficients) -> str:
    """Friction over the rows of a map: mean and standard deviation of a row."""
    mean, std = rows.mean, rows.std
    lines = [
        (
            name,
            _signed(mean[name]),
            f"{std[name]:.2g}",
            unit.ljust(4),
            _meaning(name, meaning, mean.get("alpha", 0.0) < 0),
        )
        for name, unit, meaning in (*_LAW, _FITTED)
        if name not in _BRISTLE
    ]
    header = ("coefficient", "mean", "std", "unit", "meaning")
    count = f"{len(rows.used)} rows, period {rows.period:.4g} m"
    text = [f"{count}\n{_with_meanings(header, lines)}", _NOISE]
    if rows.refused:
        text.append(f"{len(rows.refused)} rows left out, not admissible for the bristle:")
        text += [f"  row {index}: {why}" for index, why in rows.refused.items()]
    return "\n".join(text)


def _with_meanings(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Names and meanings flush left, numbers between them flush right."""
    width = max(len(row[-1]) for row in (header, *rows))
    padded = [(*row[:-1], row[-1].ljust(width)) for row in (header, *rows)]
    return table(padded[0], padded[1:], left=1)


_GRAPHS = (
    ("graph_error", "graph error/m"),
    ("dissipation_graph_error", "graph error/J"),
)


def sweep_table(dataset: "xr.Dataset") -> str:
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
    return table(header, rows)


_ERRORS = (
    ("", "state"),
    ("dissipation_", "dissipation"),
    ("strip_", "from the strip"),
    ("graph_", "graph of the state"),
    ("dissipation_graph_", "graph of the dissipation"),
)


def order_table(orders: "xr.Dataset") -> str:
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
    return table(header, rows, left=1)


def _order_cells(orders: "xr.Dataset", line: "xr.Dataset", prefix: str) -> tuple[str, ...]:
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


def spread_table(spread: "xr.Dataset") -> str:
    """One line for each error and gamma: median and 90% of orders and constants."""
    rows = [
        (
            name,
            f"{gamma:.4g}",
            _ranged(spread[f"{prefix}order"].sel(gamma=gamma), "{:.3f}"),
            _ranged(spread[f"{prefix}order_predicted"].sel(gamma=gamma), "{:.3f}"),
            _ranged(spread[f"{prefix}constant"].sel(gamma=gamma), "{:.3g}"),
            f"{int(spread.scenes.sel(gamma=gamma))}",
        )
        for prefix, name in _ERRORS
        if f"{prefix}order" in spread
        for gamma in spread.gamma.values
    ]
    header = ("error", "gamma", "order [5%, 95%]", "predicted", "constant", "rows")
    return (
        f"{table(header, rows, left=1)}\n"
        "(Median, and between which values 90% of the rows lie. Orders and constants of\n"
        "each row are for eps -> 0, by its law where its errors follow one.)"
    )


def _ranged(quantiles: "xr.DataArray", form: str) -> str:
    low, middle, high = (
        form.format(float(quantiles.sel(quantile=q))) for q in (0.05, 0.5, 0.95)
    )
    return f"{middle} [{low}, {high}]"


def lemma_table(orders: "xr.Dataset") -> str:
    """One line a gamma: the lemmas' exponent, and their constants as measured."""
    rows = []
    for gamma in orders.gamma.values:
        line = orders.sel(gamma=gamma)
        constants = formatted(float(line.C0)), formatted(float(line.C))
        rows.append((f"{gamma:.4g}", f"{float(line.beta):.3g}", *constants))
    return table(("gamma", "beta", "C0 of Lemma 7", "C of Lemma 9"), rows)


def failed_table(failed: Sequence[dict[str, Any]]) -> str:
    """One line a failed cell with the reason; says so where none failed."""
    if not failed:
        return "no cell failed"
    several = "scene" in failed[0]
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
    return _with_meanings((*scene, "gamma", "eps/m", "status", "why"), rows)


def flag_names(variable: "xr.DataArray") -> dict[int, str]:
    """Names of the integers of a CF flag variable."""
    values = np.atleast_1d(variable.attrs["flag_values"])
    names = variable.attrs["flag_meanings"].split()
    return {int(value): name for value, name in zip(values, names, strict=True)}


def _verdict(orders: "xr.Dataset", line: "xr.Dataset", prefix: str) -> str:
    name = f"{prefix}verdict"
    return flag_names(orders[name])[int(line[name])].replace("_", " ")


def _value(cell: "xr.Dataset", name: str) -> float:
    return float(cell[name]) if name in cell else float("nan")


def formatted(value: float) -> str:
    """Three digits, or a dash where there is no number."""
    return f"{value:.3g}" if np.isfinite(value) else "-"


def _signed(value: float) -> str:
    return f"{value:.6g}"


def _interval(line: "xr.Dataset", prefix: str) -> str:
    order = _value(line, prefix + "order")
    if not np.isfinite(order):
        return "-"
    low, high = (_value(line, f"{prefix}order_{end}") for end in ("low", "high"))
    return f"{order:.3f} [{low:.3f}, {high:.3f}]"


def _constant(line: "xr.Dataset", prefix: str) -> str:
    names = (f"{prefix}constant", f"{prefix}constant_low", f"{prefix}constant_high")
    constant, low, high = (formatted(_value(line, name)) for name in names)
    return constant if low == "-" else f"{constant} [{low}, {high}]"


def _slope(order: float) -> str:
    return f"{order:.3f}" if np.isfinite(order) else "-"


def _window(line: "xr.Dataset", prefix: str) -> str:
    low, high = float(line[f"{prefix}eps_min"]), float(line[f"{prefix}eps_max"])
    return f"{low:.3g} to {high:.3g}" if np.isfinite(low) else "-"


def _plain(order: float) -> str:
    return f"{order:.4g}" if np.isfinite(order) else "-"
