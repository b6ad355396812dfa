"""Numbers of a data set that somebody may have edited."""

import numpy as np
import xarray as xr

from .._checks import require
from ..wiggly import Status


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
