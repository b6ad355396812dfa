"""A sweep's data set of which one gamma, eps or time was selected, as a grid again."""

from typing import TYPE_CHECKING

from .._checks import require
from ..slide_laws import LAW_DIMS

if TYPE_CHECKING:
    import xarray as xr

_AXES = ("gamma", "eps")
_OF_TIME = (
    *("z_limit", "dissipation_limit", "load", "z_minus", "z_plus"),
    *("root_limit", "mode_limit"),
)
_SERIES = ("z", "root", "mode", "dissipation", "how", "bracket", *_OF_TIME)
_OF_SCENE = ("jumps", "jump_loss", "parts", *LAW_DIMS)


def whole_grid(dataset: "xr.Dataset") -> "xr.Dataset":
    """With dims gamma, eps and time, where `sel` or `isel` has left one value of some.

    Raises `ValueError` where a coordinate was dropped: then nobody knows the value.
    """
    if "scene" in dataset.coords and dataset["scene"].ndim == 0:
        dataset = one_scene(dataset)
    for name in (*_AXES, "time"):
        known = name in dataset.coords
        allowed = f"the values of {name}, as `isel({name}=0)` leaves them, not `drop=True`"
        require(known, "dataset", f"one without the coordinate {name}", allowed)
        if dataset[name].ndim == 0:
            dataset = _with_axis(dataset, name)
    return dataset


def one_scene(dataset: "xr.Dataset") -> "xr.Dataset":
    """A data set of several scenes of which one was selected, as that scene's own."""
    _require_of_scene(dataset)
    laws = {
        name: dataset[name].dropna(dim).values
        for name, dim in LAW_DIMS.items()
        if name in dataset
    }
    known = {name: values for name, values in laws.items() if values.size}
    own = dataset.drop_vars(["scene", "parts", *laws], errors="ignore")
    label, parts = dataset["scene"].item(), dataset["parts"].item()
    return own.assign_attrs(scene=f"{label}: {parts}", **known)


def _require_of_scene(dataset: "xr.Dataset") -> None:
    """`xr.concat` of selections gives what is a scene's own to every cell, by default."""
    whole = {"parts": (), **{name: (dim,) for name, dim in LAW_DIMS.items()}}
    for name in (one for one in whole if one in dataset.variables):
        dims = tuple(str(dim) for dim in dataset[name].dims)
        told = ", ".join(whole[name]) or "no dims"
        needs = f"{told}, of one scene: `xr.concat(..., data_vars='minimal')` leaves it"
        require(dims == whole[name], f"dataset.{name}", f"dims {', '.join(dims)}", needs)


def _with_axis(dataset: "xr.Dataset", name: str) -> "xr.Dataset":
    given = list(dataset.data_vars)
    along = (
        _SERIES
        if name == "time"
        else [v for v in given if v not in (*_OF_TIME, *_OF_SCENE)]
    )
    value = dataset[name]
    columns = {v: dataset[v] for v in given}
    bare = dataset.drop_vars([name, *given])
    columns = {
        v: column.drop_vars(name).expand_dims({name: [value.item()]})
        if v in along
        else column.drop_vars(name)
        for v, column in columns.items()
    }
    found = bare.assign(columns)
    found[name].attrs = value.attrs
    return found
