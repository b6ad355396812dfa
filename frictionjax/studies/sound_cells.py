"""Numbers of a data set that somebody may have edited."""

import numpy as np
import xarray as xr

from .._checks import require, require_real
from ..wiggly import Status

_OF_CELLS = (
    *("sup_error", "strip_excess", "status", "dissipation_error", "dissipation_gap"),
    *("graph_error", "dissipation_graph_error", "beta"),
)


def require_each_once(dataset: xr.Dataset) -> None:
    """Check that no eps or gamma is there twice, as in data sets that were joined."""
    for name in ("eps", "gamma"):
        if name not in dataset.dims or name not in dataset.coords:
            continue
        values, counts = np.unique(dataset[name].values, return_counts=True)
        twice = values[counts > 1].tolist()
        needs = f"every {name} once: `dataset.drop_duplicates({name!r})`"
        require(not twice, f"dataset.{name}", f"{twice[:1]} more than once", needs)


def require_dims_of_sweeps(dataset: xr.Dataset) -> None:
    """Check along what variables are, and the accuracy, which no variable tells."""
    cells = ({"scene"} & set(dataset.dims)) | {"gamma", "eps"}
    of_cells = {name: cells for name in _OF_CELLS if name in dataset}
    for name, dims in (of_cells | {"z": cells | {"time"}}).items():
        given = [str(dim) for dim in dataset[name].dims]
        needs = f"the dims {', '.join(sorted(dims))}, as `sweep` has them"
        require(set(given) == dims, f"dataset.{name}", f"dims {', '.join(given)}", needs)
    known = "accuracy" in dataset.attrs
    require(known, "dataset", "one without the attribute accuracy", "those of `sweep`")
    require_real("dataset.accuracy", dataset.accuracy, "accuracy > 0", lambda a: a > 0)


def require_sound_cells(dataset: xr.Dataset) -> None:
    """Check them before laws and fits meet them; `ValueError` for the first that is not."""
    for name in ("eps", "gamma"):
        _require_all(f"dataset.{name}", dataset[name], dataset[name] > 0, f"{name} > 0")
    known = {int(one): one.name for one in Status}
    allowed = "one of " + ", ".join(f"{code} ({name})" for code, name in known.items())
    _require_all(
        "dataset.status", dataset.status, dataset.status.isin(list(known)), allowed
    )
    error, ok = dataset.sup_error, dataset.status == int(Status.OK)
    good = ~ok | ((error >= 0) & np.isfinite(error))
    allowed = "a distance >= 0 in m where status is OK; another status for what failed"
    _require_all("dataset.sup_error", error, good, allowed)


def _require_all(name: str, values: xr.DataArray, good: xr.DataArray, allowed: str) -> None:
    """Raise for the first value that is not good."""
    if not bool(good.all()):
        values, good = xr.broadcast(values, good)
        require(False, name, values.values[~good.values][0].item(), allowed)
