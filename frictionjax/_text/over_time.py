"""Solutions as data sets over time."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray as xr


def dataset_over_time(
    solution: Any, columns: Mapping[str, tuple[str, str]], ended: Mapping[str, str]
) -> "xr.Dataset":
    """Of one trajectory those `columns` (unit, meaning) that it has, over `time` in s.

    `ended`: attributes.
    """
    import xarray as xr  # nothing else needs it

    data = xr.Dataset(coords={"time": ("time", np.asarray(solution.ts), {"units": "s"})})
    for name, (units, meaning) in columns.items():
        if (values := getattr(solution, name)) is not None:
            told = {"units": units, "long_name": meaning}
            data[name] = "time", np.asarray(values), told
    return data.assign_attrs(ended)
