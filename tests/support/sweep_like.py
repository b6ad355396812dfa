"""A small data set in the layout of a sweep, with known errors and one failed cell."""

import numpy as np
import xarray as xr

import frictionjax as fx

EPS = np.geomspace(0.1, 0.01, 6)
GAMMA = np.array([0.5, 1.0])


def sweep_like(failed=True, dissipation=True) -> xr.Dataset:
    """gamma = 0.5: error eps^0.5. gamma = 1: error eps, smallest eps failed."""
    time = np.linspace(0.0, 3.0, 61)
    load = np.sin(2 * np.pi * time / 3.0)
    limit = np.maximum.accumulate(np.clip(load - 0.1, 0.0, None))
    errors = np.stack([EPS**0.5, EPS])
    status = np.zeros((2, 6), dtype=np.int8)
    if failed:
        status[1, -1] = int(fx.Status.MAX_STEPS)
        errors[1, -1] = np.nan
    cells, series = ("gamma", "eps"), ("gamma", "eps", "time")
    z = limit - errors[..., None] * (time > 0.5)
    data = {
        "z": (series, z),
        "sup_error": (cells, errors),
        "strip_excess": (cells, 0.5 * errors),
        "status": (cells, status),
        "steps": (cells, np.full((2, 6), 1234)),
        "viscosity": (cells, EPS ** GAMMA[:, None]),
        "z_limit": ("time", limit),
        "z_minus": ("time", load - 0.1),
        "z_plus": ("time", load + 0.1),
        "load": ("time", load),
        "dissipation_limit": ("time", 0.1 * limit),
    }
    if dissipation:
        data |= {
            "dissipation": (series, 0.1 * z),
            "dissipation_error": (cells, 0.1 * errors),
            "dissipation_gap": (cells, 1e-9 * np.ones((2, 6))),
            "residual": (cells, 1e-8 * np.ones((2, 6))),
        }
    coords = {"gamma": GAMMA, "eps": EPS, "time": time}
    found = xr.Dataset(data, coords=coords, attrs={"accuracy": 1e-3})
    found.status.attrs["flag_values"] = np.array([int(s) for s in fx.Status], dtype=np.int8)
    found.status.attrs["flag_meanings"] = " ".join(s.name.lower() for s in fx.Status)
    return found
