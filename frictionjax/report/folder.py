"""What a study leaves in its folder."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .. import plot
from .._checks import naming, write_whole
from ..coefficients import Coefficients
from ..effects import NapFlip, nap_flip_among
from ..model import Scene
from ..studies import Study
from ..turning import flipping_rod
from ..wiggly import solve

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_TIMES = 2001  # a picture follows a rod that turns over
_SLIPS = 50  # while a rod slides as far as it reaches


def study_figures(
    found: Study, scene: Scene, law: Coefficients
) -> "Iterator[tuple[str, Figure]]":
    """The pictures of a study by file name, those that its data allow.

    `law`: friction of the scene's slides.
    """
    data = found.dataset
    if found.spread is not None:
        yield "convergence", found.plot()
        return
    yield "convergence", plot.draw_convergence(data, found.orders, found.curves)
    if bool((data.status == 0).any()):
        yield "trajectories", plot.draw_trajectories(data)
        turning = nap_flip_among(scene.effects)
        yield "loop", plot.draw_loop(data, scene.support, law)
        if "dissipation" in data:
            yield "dissipation", plot.draw_dissipation(data)
        if turning is not None:
            yield from _turning_figures(data, scene, turning)


def _turning_figures(
    data: "xr.Dataset", scene: Scene, effect: NapFlip
) -> "Iterator[tuple[str, Figure]]":
    """How the rod turns over at one eps, and both effects of its nap."""
    good = data.isel(gamma=0)
    known = good.eps.values[good.status.values == 0]
    ts = np.linspace(0.0, float(scene.duration), _TIMES)
    if known.size and bool((data["mode"] != 1).any()):
        # Slips that can be seen, and little drag.
        seen = flipping_rod(scene, effect).reach / _SLIPS
        eps = float(known[np.argmin(np.abs(np.log(known / seen)))])
        gamma, accuracy = float(good.gamma), float(data.attrs["accuracy"])
        found = solve(scene, eps, gamma, ts, accuracy)
        if np.any(np.asarray(found.mode) != 1):
            yield "turning", plot.draw_turning(scene, found, eps)
    yield "nap_loops", plot.draw_nap_loops(scene, ts)


def paper_figures() -> "Iterator[tuple[str, Figure]]":
    """The paper's figures of coefficients by file name."""
    yield "mu_slanted", plot.draw_mu_slanted()
    yield "mu_angular", plot.draw_mu_angular()
    yield "nap", plot.draw_nap()


def write_figures(folder: Path, figures: "Iterator[tuple[str, Figure]]") -> list[Path]:
    """Save pictures as PNG in `folder`."""
    paths = []
    for name, figure in figures:
        paths.append(folder / f"{name}.png")
        with naming(paths[-1]):
            figure.savefig(paths[-1])
    return paths


def write_record(
    folder: Path, data: "Mapping[str, xr.Dataset]", toml: str, text: str
) -> None:
    """Write data sets by name, scene and tables into `folder`."""
    for name, one in data.items():
        # In memory first: HDF5 ends the process where a disk is full. A copy: of a view
        # that an error keeps Python 3.13 complains when the memory is freed.
        written = bytes(one.to_netcdf(None, engine="h5netcdf"))
        write_whole(folder / f"{name}.nc", written)
    write_whole(folder / "tables.txt", text + "\n")
    write_whole(folder / "scene.toml", toml)


def write_study(
    folder: Path,
    found: Study,
    pictures: "Mapping[str, Figure]",
    toml: str,
    text: str,
) -> None:
    """Write data, orders, tables, scene and pictures of a study into `folder`."""
    data = {"study": found.dataset, "orders": found.orders}
    if found.spread is not None:
        data["spread"] = found.spread
    write_record(folder, data, toml, text)
    write_figures(folder, iter(pictures.items()))
