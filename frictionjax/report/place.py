"""A folder that is filled whole or not at all."""

import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .._checks import FULL, require

# Names of what commands write into folders.
_TEXTS = "report.html", "tables.txt", "scene.toml", "design.toml", "heights.csv", "fit.json"
_DATA = "study", "orders", "spread", "cost"
_PICTURES = (
    *("convergence", "trajectories", "loop", "dissipation", "turning", "nap_loops"),
    *("nap", "mu_slanted", "mu_angular", "work_precision", "design", "map"),
)
WRITTEN = frozenset(
    [*_TEXTS, *(f"{name}.nc" for name in _DATA), *(f"{name}.png" for name in _PICTURES)]
)


def require_folder(path: Any) -> Path:
    """Check that a folder is there or can be made; nothing is made yet.

    Raises `ValueError` where a file is in the way or its parent cannot be written to.
    """
    require(str(path) != "", "out", str(path), "the name of a folder")
    folder = Path(path)
    parent = _standing(folder)
    require(parent.is_dir(), "out", str(folder), f"a folder, but {parent} is a file")
    require(os.access(parent, os.W_OK), "out", str(folder), f"leave to write in {parent}")
    return folder


def require_no_work_lost(path: Any, ours: Iterable[str]) -> None:
    """Check that no file stands at `path`, or an empty one, or one of ours as written.

    Raises `ValueError` where somebody may have worked on it.
    """
    require(str(path) != "", "out", str(path), "the name of a file")
    file = Path(path)
    if not file.is_file():
        return
    found = file.read_bytes().replace(b"\r\n", b"\n")
    unchanged = not found or any(found == text.encode() for text in ours)
    needs = "a new name: a file is there, and it is no scene that ships"
    require(unchanged, "out", str(path), needs)


def _standing(folder: Path) -> Path:
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    return folder


def _place_in(parent: Path, folder: Path) -> Path:
    """A folder of one's own; some parents let nobody write, whatever they say."""
    try:
        return Path(tempfile.mkdtemp(prefix=".frictionjax-", dir=parent))
    except OSError as error:
        require(error.errno in FULL, "out", str(folder), f"leave to write in {parent}")
        raise


@contextmanager
def filled(folder: Path) -> Iterator[Path]:
    """A place for files that move into `folder` once all of them are written.

    Work that is interrupted or fails leaves nothing behind. A full disk is an `OSError`
    that names the file where it is going to be, or the folder where no file is known.
    """
    place = None
    try:
        place = _place_in(_standing(folder), folder)
        yield place
        folder.mkdir(parents=True, exist_ok=True)
        for path in place.iterdir():
            shutil.move(path, folder / path.name)
    except OSError as error:
        if error.errno not in FULL:
            raise
        said = f"{os.strerror(error.errno)}, nothing was written"
        name = Path(error.filename).name if error.filename else ""
        raise OSError(error.errno, said, str(folder / name)) from None
    finally:
        if place is not None:
            shutil.rmtree(place, ignore_errors=True)


def left_before(folder: Path, made: set[str]) -> list[str]:
    """Files beside those `made` now that commands write too: of an earlier run, perhaps.

    They stay, as they may be a user's own, and would be taken for this run's unnamed.
    """
    return sorted(name for name in WRITTEN - made if (folder / name).exists())
