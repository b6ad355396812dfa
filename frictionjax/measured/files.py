"""Text files of instruments: height traces and maps."""

import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..arguments import require

_PIXEL = "pixel size"
_FACTOR = "height conversion factor"
_COMMENTS = ("#", "%", ";", "//")


class Measured(NamedTuple):
    """Measured heights: positions `x` in m, shape (n,); `heights` in m, (rows, n)."""

    x: np.ndarray
    heights: np.ndarray


def read_heights(
    path: Any, pixel: float | None = None, height_scale: float | None = None
) -> Measured:
    """Read a height trace or map from a text file.

    Two columns: position and height. A map: one row a line, with lines `key=value` before
    it (`pixel size=3.7e-7 m`, `height conversion factor (-> m)=2.9e-8`, `h=305`, `w=75`).
    A single column is a trace. `pixel`: distance of samples in m, where the file does not
    say or says wrong; `height_scale`: m per unit of the file.

    Raises `ValueError`, one line, for a file that cannot be read as one of these.
    """
    try:
        text = Path(path).read_text(encoding="utf-8", errors="replace")
        header, numbers = _split(text)
        return _measured(header, numbers, pixel, height_scale)
    except OSError as error:
        raise ValueError(f"{path}: {error.strerror or error}") from None
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _split(text: str) -> tuple[dict[str, str], np.ndarray]:
    """Header entries, and the block of numbers, shape (lines, columns)."""
    header: dict[str, str] = {}
    rows: list[list[float]] = []
    for number, line in enumerate(text.splitlines(), start=1):
        row = _numbers(line)
        if row:
            rows.append(row)
        elif line.strip() and not line.strip().startswith(_COMMENTS):
            require(not rows, f"line {number}", line.strip()[:40], "numbers, after others")
            header |= _entries(line)
        if row:
            needs = f"{len(rows[0])} numbers, as in the first row"
            known = len(row) == len(rows[0])
            require(known, f"line {number}", f"{len(row)} numbers", needs)
    require(bool(rows), "numbers", "nothing", "columns of numbers: a trace or a map")
    block = np.array(rows)
    bad = np.argwhere(~np.isfinite(block))
    require(not bad.size, "numbers", "not finite", "finite heights and positions")
    return header, block


def _numbers(line: str) -> list[float]:
    """The numbers of a line; none where anything in it is not a number."""
    for fields in (line.split(), re.split(r"[,;\t]", line.strip().rstrip(",;"))):
        try:
            return [float(field) for field in fields]
        except ValueError:
            continue
    return []


def _entries(line: str) -> dict[str, str]:
    """`h=305 w=75` and `pixel size=3.7e-7 m`, the keys in lower case."""
    short = re.findall(r"\b([hw])\s*=\s*(\d+)\b", line)
    key, _, value = line.partition("=")
    return dict(short) or ({key.strip().lower(): value.strip()} if value else {})


def _measured(header, numbers, pixel, height_scale) -> Measured:
    stated = _stated(header, _PIXEL)
    columns = numbers.shape[1]
    for name, given in (("pixel", pixel), ("height_scale", height_scale)):
        good = given is None or (np.isfinite(given) and given > 0)
        require(good, name, given, f"{name} > 0")
    if columns == 2 and stated is None:
        require(pixel is None, "pixel", pixel, "none: the file has a column of positions")
        x, heights = numbers[:, 0], numbers[None, :, 1]
        require(bool(np.all(np.diff(x) > 0)), "positions", x, "increasing positions")
        return Measured(x, heights * (1.0 if height_scale is None else height_scale))
    heights = numbers.T if columns == 1 else numbers
    _require_shape(header, heights)
    pixel = stated if pixel is None else pixel
    require(pixel is not None, "pixel", "nothing", "the distance of samples in m")
    scale = _stated(header, _FACTOR) if height_scale is None else height_scale
    known = scale is not None or header.get("data unit", "m") == "m"
    needs = f"m per {header.get('data unit')}: the file has no height conversion factor"
    require(known, "height_scale", "nothing", needs)
    assert pixel is not None
    x = pixel * np.arange(heights.shape[1])
    return Measured(x, heights * (1.0 if scale is None else scale))


def _stated(header: dict[str, str], key: str) -> float | None:
    """A positive number that the header gives for a key, which may carry a unit."""
    for name, text in header.items():
        if name.startswith(key):
            number = re.match(r"[-+.\deE]+", text)
            value = float(number.group()) if number else float("nan")
            require(value > 0, name, text, "a number > 0 in m")
            return value
    return None


def _require_shape(header: dict[str, str], heights: np.ndarray) -> None:
    for key, size in zip("hw", heights.shape, strict=True):
        said = int(header.get(key, size))
        require(said == size, key, said, f"{size}, the size of the block of numbers")
