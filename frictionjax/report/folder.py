"""The folder that a study leaves behind."""

import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from .. import plot
from ..arguments import require
from ..coefficients import Coefficients
from ..scene import Scene
from ..studies import Study


def require_folder(path: Any) -> Path:
    """Check that a folder is there or can be made; nothing is made yet.

    Raises `ValueError` where a file is in the way or its parent cannot be written to.
    """
    folder = Path(path)
    parent = _standing(folder)
    require(parent.is_dir(), "out", str(folder), f"a folder, but {parent} is a file")
    require(os.access(parent, os.W_OK), "out", str(folder), f"leave to write in {parent}")
    return folder


def _standing(folder: Path) -> Path:
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    return folder


@contextmanager
def filled(folder: Path) -> Iterator[Path]:
    """A place for files that move into `folder` once all of them are written.

    Work that is interrupted or fails leaves nothing behind.
    """
    place = Path(tempfile.mkdtemp(prefix=".frictionjax-", dir=_standing(folder)))
    try:
        yield place
        folder.mkdir(parents=True, exist_ok=True)
        for path in place.iterdir():
            shutil.move(path, folder / path.name)
    finally:
        shutil.rmtree(place, ignore_errors=True)


def study_figures(
    found: Study, scene: Scene, law: Coefficients
) -> Iterator[tuple[str, Figure]]:
    """The pictures of a study by file name, those that its data allow."""
    data = found.dataset
    yield "convergence", plot.draw_convergence(data, found.orders)
    if bool((data.status == 0).any()):
        yield "trajectories", plot.draw_trajectories(data)
        yield "loop", plot.draw_loop(data, scene.support, law)
        if "dissipation" in data:
            yield "dissipation", plot.draw_dissipation(data)


def paper_figures() -> Iterator[tuple[str, Figure]]:
    """The paper's figures of coefficients by file name."""
    yield "mu_slanted", plot.draw_mu_slanted()
    yield "mu_angular", plot.draw_mu_angular()
    yield "nap", plot.draw_nap()


def write_figures(folder: Path, figures: Iterator[tuple[str, Figure]]) -> list[Path]:
    """Save pictures as PNG in `folder`."""
    paths = []
    for name, figure in figures:
        paths.append(folder / f"{name}.png")
        figure.savefig(paths[-1])
    return paths


def write_record(
    folder: Path, data: Mapping[str, xr.Dataset], toml: str, text: str
) -> None:
    """Write data sets by name, scene and tables into `folder`."""
    for name, one in data.items():
        one.to_netcdf(folder / f"{name}.nc", engine="h5netcdf")
    (folder / "tables.txt").write_text(text + "\n", encoding="utf-8")
    (folder / "scene.toml").write_text(toml, encoding="utf-8")


def write_study(
    folder: Path, found: Study, scene: Scene, law: Coefficients, toml: str, text: str
) -> None:
    """Write data, orders, tables, scene and pictures of a study into `folder`."""
    write_record(folder, {"study": found.dataset, "orders": found.orders}, toml, text)
    write_figures(folder, study_figures(found, scene, law))
