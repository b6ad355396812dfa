"""Measured heights out of files: texts, and formats of instruments."""

import re
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from .._text import decoded
from .columns import read_text
from .gaps import without_gaps
from .instruments import is_instrument_text, read_instrument
from .scales import asked_of

_CONTROL = re.compile("[\x00-\x08\x0e-\x19\x1b-\x1f]")  # ^Z ends a text of DOS


class MeasuredWarning(UserWarning):
    """What `read_heights` has taken for granted, or filled.

    >>> import warnings
    >>> x = np.linspace(0.0, 1.0, 101)
    >>> np.savetxt("trace.txt", np.c_[x, 0.02 * np.sin(10 * np.pi * x)])
    >>> with warnings.catch_warnings(action="ignore", category=fx.measured.MeasuredWarning):
    ...     print(fx.measured.read_heights("trace.txt").notes[0])
    line 1, columns 1 and 2: no unit of lengths and heights, read as m (see ...
    """


class Measured(NamedTuple):
    """Measured heights: positions `x` in m, shape (n,); `heights` in m, (rows, n).

    `notes`: one line for each thing that is not as the file says, or that it does not say:
    a unit, missing heights, an order of columns.

    >>> x = np.linspace(0.0, 1e-4, 201)
    >>> groove = fx.measured.Measured(x, 3e-7 * np.sin(2 * np.pi * x / 2e-5)[None])
    >>> print(f"{fx.measured.fit_profile(groove, harmonics=2).period:.2e} m")
    2.00e-05 m
    """

    x: Float[np.ndarray, " n"]
    heights: Float[np.ndarray, "*rows n"]
    notes: Sequence[str] = ()


def read_heights(
    path: Any,
    pixel: float | None = None,
    height_scale: float | None = None,
    length_unit: str | None = None,
    height_unit: str | None = None,
    decimal: str | None = None,
    outliers: str | None = None,
) -> Measured:
    """Read a height trace or map from a file, at `path`.

    A text: two columns, position and height; three, x, y and z on a grid; a map, one row
    a line, with lines `key=value` before it (`pixel size=3.7e-7 m`,
    `height conversion factor (-> m)=2.9e-8`, `h=305`, `w=75`); a single column is a trace.
    Units are those of its heading (`X (um);Z (nm)`) or of lines as `# Value units: nm`.
    Anything else is read by SurfaceTopography, which knows some 40 formats of instruments
    (`pip install "frictionjax[instruments]"`).

    `pixel`: distance of samples, where the file does not say or says wrong, in m, or in
    `length_unit` where that is given. `length_unit`, `height_unit`: units of positions and
    heights, as "um", before those that the file states. `height_scale`: m per unit of the
    heights, in place of `height_unit`. `decimal`: the mark of decimals, "." or ",", where
    the file can be read both ways. `outliers`: "missing" or "keep", where heights lie
    alone, further from all others than those from each other.

    Numbers without any unit are m where they can be: a trace of at most 1 m with a mean
    slope of at most 3. Missing heights (NaN, BAD, empty cells, masked samples, values as
    -32768 or 1e38) are cut off at the ends, and filled by straight lines over gaps of at
    most a tenth of the period, or one sample. All of this is in `.notes`, and a
    `MeasuredWarning`.

    Returns a `Measured`: `.x` in m, shape (n,), `.heights` in m, (rows, n), `.notes`.

    Raises `ValueError`, one line with file, line and column, for a file that cannot be
    read as one of these, or has a unit of lengths and none of heights.

    >>> x = np.linspace(0.0, 100.0, 201)
    >>> np.savetxt("trace.txt", np.c_[x, 0.3 * np.sin(2 * np.pi * x / 20)])
    >>> groove = fx.measured.read_heights("trace.txt", length_unit="um", height_unit="um")
    >>> print(f"{groove.x[-1]:.1e} m long, up to {groove.heights.max():.1e} m high")
    1.0e-04 m long, up to 3.0e-07 m high
    """
    options = pixel, height_scale, length_unit, height_unit, decimal, outliers
    measured = heights_of(path, *options)
    for note in measured.notes:
        warnings.warn(f"{path}: {note}", MeasuredWarning, stacklevel=2)
    return measured


def heights_of(
    path: Any,
    pixel: float | None = None,
    height_scale: float | None = None,
    length_unit: str | None = None,
    height_unit: str | None = None,
    decimal: str | None = None,
    outliers: str | None = None,
) -> Measured:
    """`read_heights` without its warnings: its notes say the same."""
    options = pixel, height_scale, length_unit, height_unit, decimal, outliers
    try:
        asked = asked_of(*options)
        data = Path(path).read_bytes()
        text = None if is_instrument_text(data) else _text_of(data)
        if text is None:
            samples = read_instrument(data, Path(path).suffix.lower(), asked)
        else:
            samples = read_text(text, asked)
        samples = without_gaps(samples)
    except OSError as error:
        raise ValueError(f"{path}: {error.strerror or error}") from None
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    return Measured(samples.x, samples.heights, tuple(samples.notes))


def _text_of(data: bytes) -> str | None:
    """The text of a file; None where it is none."""
    try:
        text = decoded(data, "latin-1")
    except ValueError:
        return None
    return None if _CONTROL.search(text) else text
