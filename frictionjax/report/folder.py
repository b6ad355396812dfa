"""What a study leaves in its folder."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from .. import plot
from .._checks import naming, write_whole
from ..model import Coefficients, Scene
from ..studies import Study

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def study_figures(
    found: Study, scene: Scene, law: Coefficients
) -> "Iterator[tuple[str, Figure]]":
    """The pictures of a study by file name, those that its data allow."""
    data = found.dataset
    if found.spread is not None:
        yield "convergence", found.plot()
        return
    yield "convergence", plot.draw_convergence(data, found.orders, found.curves)
    if bool((data.status == 0).any()):
        yield "trajectories", plot.draw_trajectories(data)
        yield "loop", plot.draw_loop(data, scene.support, law)
        if "dissipation" in data:
            yield "dissipation", plot.draw_dissipation(data)


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
        # In memory first: HDF5 ends the process where a disk is full.
        write_whole(folder / f"{name}.nc", one.to_netcdf(None, engine="h5netcdf"))
    write_whole(folder / "tables.txt", text + "\n")
    write_whole(folder / "scene.toml", toml)


def write_study(
    folder: Path, found: Study, scene: Scene, law: Coefficients, toml: str, text: str
) -> None:
    """Write data, orders, tables, scene and pictures of a study into `folder`."""
    data = {"study": found.dataset, "orders": found.orders}
    if found.spread is not None:
        data["spread"] = found.spread
    write_record(folder, data, toml, text)
    write_figures(folder, study_figures(found, scene, law))
