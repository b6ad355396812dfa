"""How far orders and constants of a study spread over its scenes."""

import numpy as np
import xarray as xr

QUANTILES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)
_PREFIXES = ("", "dissipation_", "strip_", "graph_", "dissipation_graph_")
_NUMBERS = ("order", "order_seen", "order_predicted", "constant", "constant_predicted")
_LEMMAS = ("C0", "C")


def spread_over_scenes(orders: xr.Dataset) -> xr.Dataset:
    """Quantiles over the scenes of a study's orders and constants, for each gamma.

    NaNs are left out; `scenes` counts those whose order of the sup error is known,
    `predicted_scenes` those of which a law says it, and so with prefixes.
    """
    wanted = [prefix + name for prefix in _PREFIXES for name in _NUMBERS] + [*_LEMMAS]
    columns = {
        name: (("quantile", "gamma"), _quantiles(orders[name]))
        for name in wanted
        if name in orders
    }
    counts = {
        f"{prefix}predicted_scenes": ("gamma", _known(orders[f"{prefix}order_predicted"]))
        for prefix in _PREFIXES
        if f"{prefix}order_predicted" in orders
    }
    data = xr.Dataset(
        {**columns, **counts, "scenes": ("gamma", _known(orders.order))},
        coords={"quantile": list(QUANTILES), "gamma": orders.gamma.values},
    )
    for name in columns:
        data[name].attrs = dict(orders[name].attrs)
    for name in counts:
        data[name].attrs["long_name"] = "scenes whose order a law predicts"
    data["scenes"].attrs["long_name"] = "scenes whose order is known"
    data["quantile"].attrs["long_name"] = "share of the scenes that lie below"
    return data


def _known(column: xr.DataArray) -> np.ndarray:
    """In how many scenes a number is known, for each gamma."""
    values = column.transpose("scene", "gamma").values
    return np.count_nonzero(np.isfinite(values), axis=0)


def _quantiles(column: xr.DataArray) -> np.ndarray:
    values = column.transpose("scene", "gamma").values
    found = np.full((len(QUANTILES), values.shape[1]), np.nan)
    for place, row in enumerate(values.T):
        known = row[np.isfinite(row)]
        if known.size:
            found[:, place] = np.quantile(known, QUANTILES)
    return found
