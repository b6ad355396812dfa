"""A convergence study: orders, constants and failures of a sweep."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from .._checks import kind_of, require, require_flags
from .._compile import waiting
from ..convergence import (
    ENERGY,
    STATE,
    Fit,
    LawFit,
    Trust,
    Verdict,
    fit_with_law,
    local_orders,
)
from ..slide_laws import NO_LAW, Prediction, SlideData, predict_errors
from ..sweeps import one_scene, whole_grid
from ..wiggly import Status, warn_of_failed
from .scene_spread import spread_over_scenes
from .sound_cells import require_dims_of_sweeps, require_each_once, require_sound_cells
from .study_result import Study

_MOST_PAIRS = 400  # times compared with each other for the constant of Lemma 9


def study(dataset: xr.Dataset, *, progress: bool = False) -> Study:
    """Convergence orders of a `dataset` made by `sweep`.

    Returns a `Study`: `.orders` holds, for each gamma: `order, order_low, order_high` of
    `sup_error` (95% interval for eps -> 0), the window `eps_min, eps_max, points` it rests
    on, how many cells were left out as pre-asymptotic, near the solver's floor or failed,
    `constant` of the power for eps -> 0 with its 95% interval `constant_low, constant_high`
    (jointly with that of the order), `order_seen` (slope of the errors in the window, by
    plain regression), `misfit` of the fitted curve, `verdict` (CF flags); the same with
    `dissipation_` in front, and with `strip_` of sup dist(z_eps, strip);
    `beta = min(1, gamma)` of Lemmas 7 to 9; the measured constants `C0` of Lemma 7 and `C`
    of Lemma 9, the latter a lower bound from the times in the data set.

    `order_predicted`, `constant_predicted`: what the laws of a slide say for eps -> 0, NaN
    where they say nothing: `min(1, gamma p/(p - 1))` for the sup error, with p the flatness
    of W' where it is extreme, 2 for the usual fold. That constant of dissipation is
    a part only, within 70% in 14 scenes: what is lost before the first slip, and how far in
    its well a slide starts, are of the same power. `law` says on what `order` rests:
    "averaged" (wells passed without a rest), "slips" (tips rest before each), "between"
    (at the threshold), or "free": errors that do not follow the prediction, or have none,
    are fitted freely, and their interval is that of `orders.fit_order`. Where a law is
    used, order and interval are those of the ratio of errors to prediction, see
    `law_orders.fit_with_law`. They are for eps -> 0: where the verdict is `not_yet_seen`
    the law's own curve has not come to this power at the smallest eps, so that order and
    constant are theory's, confirmed through the law; what the data alone show is
    `order_seen` and, where a law is used, `.curves`. (The paper proves no rate for the sup
    error.)

    Of a scene with `effects.Inertia` there are no laws, and `inertia_order` is the power of
    eps with which `beta` of the data set goes to 0, `exponent - 1 - 2 gamma`; where it is
    not positive the system is not overdamped for eps -> 0: `overdamped` is 0 there, the
    attribute `inertia` says it in words, and errors need not vanish.

    Of a scene with `effects.NapFlip` there are no laws either. Where its limit jumps, sup
    errors do not vanish, but the distances of graphs do: columns with `graph_` and
    `dissipation_graph_` in front are of these, and the attribute `turning` says it in
    words. There is no strip, and so nothing of it.

    Of a scene with `effects.Noise` errors are those of one path a cell, fitted freely, and
    `noise_order` is the power of eps with which `T_eps/eps` falls, `exponent - 1`; where it
    is not positive noise takes all friction as eps -> 0 (`benchmarks/noise.py` measures
    how), and the attribute `noise` says so.

    Cells that failed are left out, and a warning (`FailedCells`) names them. Each of
    several scenes is studied alone; `.spread` tells how they differ.

    `progress`: a line on standard error where it takes more than two seconds: laws compile.

    Raises `ValueError` where the data set lacks what `sweep` puts there, or has it along
    other dims, and for an eps or gamma that is not positive or there twice, a status
    that is none, and a cell that is OK without a distance from the limit.

    >>> found = fx.study(fx.sweep(scene, eps=[0.1, 0.03, 0.01, 0.003, 0.001], gamma=1.0))
    >>> order = found.orders.sel(gamma=1.0)
    >>> print(f"{order.order:.2f}, 95% [{order.order_low:.2f}, {order.order_high:.2f}]")
    1.01, 95% [0.87, 1.15]
    """
    needed = {"sup_error", "status", "strip_excess", "z"}
    given = getattr(dataset, "variables", None)
    allowed = "a data set that `sweep` has made"
    require(given is not None, "dataset", kind_of(dataset), allowed)
    missing = ", ".join(sorted(needed - set(given or ())))
    allowed = "one that `sweep` has made, with suprema=True"
    require(not missing, "dataset", f"one without {missing}", allowed)
    require_each_once(dataset)
    dataset = whole_grid(dataset)
    require_dims_of_sweeps(dataset)
    require_sound_cells(dataset)
    codes = dataset.status.transpose(..., "gamma", "eps").values
    require_flags(progress=progress)
    several = "scene" in dataset.dims
    labels = dataset.scene.values if several else ()
    warn_of_failed(codes, dataset.gamma.values, dataset.eps.values, labels)
    with waiting("study", progress) as tell:
        if several:
            return _study_of_scenes(dataset, tell)
        tell("laws and orders")
        return _study_of_one(dataset)


def _study_of_scenes(dataset: xr.Dataset, tell: Callable[[str], None]) -> Study:
    labels = dataset.scene
    found = []
    for i in range(labels.size):
        tell(f"laws and orders, scene {i + 1} of {labels.size}")
        found.append(_study_of_one(one_scene(dataset.isel(scene=i))))

    def joined(parts: list[xr.Dataset]) -> xr.Dataset:
        return xr.concat(parts, labels, join="exact", combine_attrs="drop_conflicts")

    orders = joined([one.orders for one in found])
    failed = [
        {"scene": label, **cell}
        for label, one in zip(labels.values.tolist(), found, strict=True)
        for cell in one.failed
    ]
    return Study(
        orders=orders,
        local_orders=joined([one.local_orders for one in found]),
        failed=failed,
        dataset=dataset,
        curves=joined([one.curves for one in found]),
        spread=spread_over_scenes(orders),
    )


def _study_of_one(dataset: xr.Dataset) -> Study:
    gammas = dataset.gamma.values
    laws = _predictions(dataset)
    columns: dict[str, np.ndarray] = {}
    curves: dict[str, np.ndarray] = {}
    for error in _ERRORS:
        if error.name in dataset and "missing" not in dataset[error.name].attrs:
            fits = _fits(dataset, error, laws.get(error.name))
            columns |= _columns(error.prefix, fits, laws.get(error.name))
            curves[f"{error.name}_fitted"] = np.array([fit.fitted for fit in fits])
            if error.name in laws:
                curves[f"{error.name}_predicted"] = laws[error.name].errors
    if "beta" in dataset and np.isfinite(dataset.beta).any():  # a scene with inertia
        columns |= _inertia_columns(dataset)
    if "thermal_share" in dataset and np.isfinite(dataset.thermal_share).any():
        columns["noise_order"] = _powers(dataset, "thermal_share")
    columns["beta"] = np.minimum(1.0, gammas)
    columns["C0"] = np.array([_lemma_7(dataset.sel(gamma=g)) for g in gammas])
    columns["C"] = np.array([_lemma_9(dataset.sel(gamma=g)) for g in gammas])
    orders = xr.Dataset(
        {name: ("gamma", values) for name, values in columns.items()},
        coords={"gamma": gammas},
        attrs=dataset.attrs,
    )
    if "inertia_order" in orders:
        orders.attrs["inertia"] = _inertia_message(orders)
    if "graph_error" in dataset:  # a scene with a rod that turns over
        orders.attrs["turning"] = _turning_message(dataset)
    if "noise_order" in orders:
        orders.attrs["noise"] = _noise_message(orders)
    along = xr.Dataset(
        {name: (("gamma", "eps"), values) for name, values in curves.items()},
        coords={"gamma": gammas, "eps": dataset.eps.values},
    )
    return Study(_described(orders), _local(dataset), _failed(dataset), dataset, along)


class _Error(NamedTuple):
    """An error of a data set, what stands before its columns, and how laws know it."""

    name: str
    prefix: str
    trust: Trust


_ERRORS = (
    _Error("sup_error", "", STATE),
    _Error("dissipation_error", "dissipation_", ENERGY),
    _Error("strip_excess", "strip_", STATE),
    _Error("graph_error", "graph_", STATE),
    _Error("dissipation_graph_error", "dissipation_graph_", ENERGY),
)
_FIELDS = {"low": "order_low", "high": "order_high", "seen": "order_seen"}


def _predictions(dataset: xr.Dataset) -> dict[str, Prediction]:
    """What the laws say of the cells, by name of the error; empty if nothing is known."""
    data = SlideData.of(dataset.attrs)
    if data is None:
        return {}
    return predict_errors(data, dataset.eps.values, dataset.gamma.values)


def _fits(dataset: xr.Dataset, error: _Error, laws: Prediction | None) -> list[LawFit]:
    good = dataset.status == int(Status.OK)
    errors = dataset[error.name].where(good).transpose("gamma", "eps").values
    own = dataset.accuracy * dataset.eps
    if error.trust is ENERGY:
        own = dataset.dissipation_gap
    known = own.broadcast_like(dataset.sup_error).transpose("gamma", "eps").values
    eps = dataset.eps.values
    return [
        fit_with_law(
            eps,
            errors[i],
            known[i],
            None if laws is None else laws.errors[i],
            NO_LAW if laws is None else laws.laws[i],
            error.trust,
        )
        for i in range(dataset.gamma.size)
    ]


def _columns(
    prefix: str, fits: list[LawFit], laws: Prediction | None
) -> dict[str, np.ndarray]:
    names = {name: prefix + _FIELDS.get(name, name) for name in Fit._fields}
    columns = {
        label: np.array([getattr(one.fit, name) for one in fits])
        for name, label in names.items()
    }
    columns[f"{prefix}law"] = np.array([one.law.name for one in fits], dtype=object)
    columns[f"{prefix}order_predicted"] = np.array([one.law.order for one in fits])
    columns[f"{prefix}constant_predicted"] = np.array([one.law.constant for one in fits])
    return columns


def _inertia_columns(dataset: xr.Dataset) -> dict[str, np.ndarray]:
    """The power of eps that beta falls with, for each gamma."""
    power = _powers(dataset, "beta")
    return {"inertia_order": power, "overdamped": (power > 0).astype(np.int8)}


def _powers(dataset: xr.Dataset, name: str) -> np.ndarray:
    """With which a variable falls with eps, for each gamma: exact, as it is a power."""
    if dataset.eps.size < 2:
        return np.full(dataset.gamma.size, np.nan)
    size = np.log(dataset[name].transpose("gamma", "eps").values)
    return np.round((size[:, 0] - size[:, -1]) / np.log(_ratio(dataset)), 9)


def _noise_message(orders: xr.Dataset) -> str:
    """Of a scene with noise: whether its limit is dry friction."""
    if np.all(orders.noise_order.values > 0):
        return "the temperature falls faster than eps: dry friction for eps -> 0"
    return (
        "the temperature does not fall faster than eps: noise takes all friction as "
        "eps -> 0, and the limit is not the play operator"
    )


def _ratio(dataset: xr.Dataset) -> float:
    return float(dataset.eps[0] / dataset.eps[-1])


def _inertia_message(orders: xr.Dataset) -> str:
    """Of a scene with inertia: for which gamma its limit is that of overdamped tips."""
    never = orders.gamma.values[orders.overdamped.values == 0]
    if never.size == 0:
        return "the mass falls faster than eps^(1 + 2 gamma): overdamped for eps -> 0"
    named = ", ".join(f"{gamma:.4g}" for gamma in never)
    return (
        f"gamma = {named}: the mass does not fall faster than eps^(1 + 2 gamma), so tips "
        "are not overdamped for eps -> 0; the limit need not be the play operator"
    )


def _turning_message(dataset: xr.Dataset) -> str:
    """Of a scene whose rod turns over: which of its errors vanish."""
    jumps, lost = int(dataset.jumps), float(dataset.jump_loss)
    if jumps == 0:
        return "the limit does not jump: sup errors vanish, and so do those of graphs"
    times = "once" if jumps == 1 else f"{jumps} times"
    return (
        f"the limit jumps {times} and loses {lost:.6g} J in doing so: the wiggly system "
        "gets over later, so sup errors do not vanish; orders are those of the graphs"
    )


def _lemma_7(cells: xr.Dataset) -> float:
    """Smallest C0 with `dist(z_eps, strip) <= C0 eps^beta` in all cells of one gamma."""
    beta = min(1.0, float(cells.gamma))
    return float((cells.strip_excess / cells.eps**beta).max())


def _lemma_9(cells: xr.Dataset) -> float:
    """Smallest C with `|z(t) - z(s)| <= C (|t - s| + eps^beta)` at the times kept."""
    beta = min(1.0, float(cells.gamma))
    thin = cells.isel(time=slice(None, None, 1 + cells.time.size // _MOST_PAIRS))
    gaps = np.abs(thin.time.values[:, None] - thin.time.values)
    worst = 0.0
    for eps in thin.eps.values:
        z = thin.z.sel(eps=eps).values
        ratio = np.abs(z[:, None] - z) / (gaps + eps**beta)
        worst = max(worst, float(np.nanmax(ratio)) if np.isfinite(z).any() else 0.0)
    return worst


def _local(dataset: xr.Dataset) -> xr.Dataset:
    eps = dataset.eps.values
    good = dataset.status == int(Status.OK)
    data = xr.Dataset(
        coords={"gamma": dataset.gamma.values, "eps": np.sqrt(eps[1:] * eps[:-1])}
    )
    for label, name in (("order", "sup_error"), ("dissipation_order", "dissipation_error")):
        if name in dataset:
            errors = dataset[name].where(good).transpose("gamma", "eps").values
            rows = [local_orders(eps, row) for row in errors]
            data[label] = (("gamma", "eps"), np.array(rows))
            data[label].attrs = {"units": "1", "long_name": f"local order of {name}"}
    data.eps.attrs = {"units": "m", "long_name": "geometric mean of two neighbouring eps"}
    return data


def _failed(dataset: xr.Dataset) -> list[dict[str, Any]]:
    codes = dataset.status.transpose("gamma", "eps").values
    return [
        {
            "gamma": float(dataset.gamma[i]),
            "eps": float(dataset.eps[j]),
            "status": Status.of(codes[i, j]).name.lower(),
            "message": Status.of(codes[i, j]).message,
        }
        for i, j in np.argwhere(codes != int(Status.OK))
    ]


_MEANING = {
    "order": ("1", "order of convergence"),
    "order_low": ("1", "lower end of its 95% interval"),
    "order_high": ("1", "upper end of its 95% interval"),
    "order_seen": ("1", "slope of log error over log eps in the window"),
    "eps_min": ("m", "smallest eps of the window"),
    "eps_max": ("m", "largest eps of the window"),
    "points": ("1", "cells in the window"),
    "preasymptotic": ("1", "cells left out, eps too large"),
    "floor": ("1", "cells left out, error near the solver's own"),
    "failed": ("1", "cells left out, failed"),
    "beta": ("1", "exponent min(1, gamma) of Lemmas 7 to 9"),
    "inertia_order": ("1", "power of eps with which m_eps max|W''|/eps^(1+2 gamma) falls"),
    "overdamped": (None, "1 where mass does not matter for eps -> 0"),
    "noise_order": ("1", "power of eps with which T_eps/eps falls"),
    "C0": ("m^(1-beta)", "smallest C0 of Lemma 7 in these cells"),
    "C": ("m/s, m^(1-beta)", "smallest C of Lemma 9 in these cells"),
    "constant": (None, "error over eps^order for eps -> 0"),
    "constant_low": (None, "lower end of its 95% interval, jointly with the order's"),
    "constant_high": (None, "upper end of its 95% interval, jointly with the order's"),
    "misfit": ("1", "largest factor by which the fitted curve misses a point"),
    "law": (None, "law that the order rests on"),
    "order_predicted": ("1", "order that the law has for eps -> 0"),
    "constant_predicted": (None, "error over eps^order that the law has for eps -> 0"),
    "verdict": (None, "what the interval says"),
}
_COMMENTS = {
    "C0": "Its unit is that of an error over eps^beta: 1 for gamma >= 1.",
    "C": "In m/s before |t - s|, in m^(1-beta) before eps^beta: one C for both.",
    "constant": (
        "Of the leading power, by the law where one is used. Errors of the data set are "
        "those of .curves, not constant eps^order, where the verdict is not_yet_seen."
    ),
    "constant_predicted": (
        "Of dissipation a part only: what is lost before the first slip, and how far in "
        "its well a slide starts, are of the same power."
    ),
    "misfit": (
        "In the window, of what was fitted: the law's curve times a power where a law is "
        "used, see .curves, constant eps^order where the law is free."
    ),
    "order": "For eps -> 0; what the errors of the window show alone is order_seen.",
    "verdict": (
        "not_yet_seen: errors follow the law, but not yet its power of eps -> 0; order "
        "and constant are theory's, confirmed through the law."
    ),
}


def _described(orders: xr.Dataset) -> xr.Dataset:
    for name in map(str, orders.data_vars):
        error = next(e for e in reversed(_ERRORS) if name.startswith(e.prefix))
        bare = name.removeprefix(error.prefix)
        units, meaning = _MEANING[bare]
        if bare in _COMMENTS:
            orders[name].attrs["comment"] = _COMMENTS[bare]
        of = error.name
        lemma = name in ("beta", "C0", "C", "inertia_order", "overdamped")
        orders[name].attrs["long_name"] = meaning if lemma else f"{meaning} ({of})"
        if units is not None:
            orders[name].attrs["units"] = units
        if name.endswith("verdict"):
            orders[name] = orders[name].astype(np.int8)
            orders[name].attrs["flag_values"] = np.array(list(Verdict), dtype=np.int8)
            orders[name].attrs["flag_meanings"] = " ".join(v.name.lower() for v in Verdict)
    return orders
