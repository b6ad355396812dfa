"""Formats of instruments, through SurfaceTopography."""

import contextlib
import io
import warnings
from typing import Any

import numpy as np

from .._checks import require
from .axes import axis_of
from .samples import HeightSamples
from .scales import GivenUnits, Scale, completed, require_metres
from .sentinels import without_sentinels
from .units import ALLOWED, metres

_TEXTS = ("aISO-1.0", "fileformat = bcr", "fileType")  # formats that may be read as text
_WITHOUT_MAGIC = ("hgt", "nms")  # read any file of a fitting size
_BARE = ("npy", "npz", "mat", "h5")  # arrays without units; here, rows of samples
_NOWHERE = np.empty((0, 0), int)
_UNKNOWN = "no text, and no format that SurfaceTopography knows"
_EXTRA = 'a text, or `pip install "frictionjax[instruments]"` for formats of instruments'


def is_instrument_text(data: bytes) -> bool:
    """Whether a file is of an instrument's format though it may be text."""
    begins = data[:80].replace(b"\0", b"").lstrip(b"\xff\xfe")
    return begins.startswith(tuple(name.encode() for name in _TEXTS))


def read_instrument(data: bytes, suffix: str, asked: GivenUnits) -> HeightSamples:
    """Heights of a file that is no plain text, NaN where one is missing.

    Several channels: the file's first one of heights. Raises `ValueError` where no
    reader knows the file, and where it has no sizes or units and the user gives none.
    """
    # Readers warn of optional packages and odd headers, and print what they tried.
    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("ignore")
        try:
            from SurfaceTopography.IO import open_topography
        except ImportError:
            require(False, "file", "binary", _EXTRA)
        try:
            # Out of memory: some readers leave files open.
            with open_topography(io.BytesIO(data)) as reader:
                return _samples(reader, suffix, asked)
        except Exception as error:  # each reader has errors of its own
            said = " ".join(str(error).split())[:200]
            unknown = type(error).__name__ == "CannotDetectFileFormat"
            refused = _UNKNOWN if unknown else said or type(error).__name__
            raise ValueError(refused) from None


def _samples(reader: Any, suffix: str, asked: GivenUnits) -> HeightSamples:
    form = reader.format()
    guessed = form in _WITHOUT_MAGIC and suffix != f".{form}"
    require(not guessed, "file", "binary", "a format that SurfaceTopography knows")
    channel, notes = _channel(reader)
    sizes = channel.physical_sizes
    uneven = channel.is_uniform is False  # a trace with positions has no sizes
    known = {} if sizes is not None or uneven else {"physical_sizes": channel.nb_grid_pts}
    surface = reader.topography(channel_index=channel.index, **known)
    x, heights = _arrays(surface, form in _BARE)
    pixel = asked.pixel_in_metres
    place = f"format {form}, channel {channel.name}"
    needs = "the distance of samples in m, or in length_unit: the file has none"
    placed = sizes is not None or pixel is not None or uneven
    require(placed, "pixel", "nothing", needs)
    rising = bool(np.all(np.diff(x) > 0))
    require(rising, place, "positions that fall back", "increasing positions")
    unit = surface.unit
    value = None if unit is None else metres(unit)
    require(unit is None or value is not None, place, unit, ALLOWED)
    heights_by, lengths_by = _scales(value, unit, asked)
    if pixel is not None:
        require(surface.is_uniform, "pixel", pixel, "none: the file has positions")
        x, lengths_by = pixel * np.arange(x.size), Scale(1.0, "pixel")
    if form in _BARE and heights.shape[0] > 1:
        notes.append(
            f"{place}: {heights.shape[0]} rows of {x.size}, the last index along x"
        )
        axis = axis_of(heights)
        values = heights[:, 0] if axis == 1 else heights[0]
        needs = "heights: these go evenly, as positions do, unlike others; take them out"
        require(axis is None, ("first row", "first column")[axis or 0], values, needs)
    found = without_sentinels(
        HeightSamples(x, heights, notes, _NOWHERE, _NOWHERE), asked.outliers
    )
    along, up, unsaid = completed(lengths_by, heights_by, place)
    x, heights = along * x, up * found.heights
    if unsaid:
        require_metres(x, heights, place)
    return found._replace(x=x, heights=heights, notes=[*found.notes, *unsaid])


def _channel(reader: Any) -> tuple[Any, list[str]]:
    """The file's own choice where that is of heights, else its first one that is."""
    channels = reader.channels
    heights = [c for c in channels if c.is_height_channel]
    names = ", ".join(str(c.name) for c in channels)[:100]
    require(bool(heights), "channels", names, "one of heights")
    default = reader.default_channel
    chosen = default if default.is_height_channel else heights[0]
    said = f"channel {chosen.name}, of {len(channels)} ({names})"
    return chosen, [said] if len(channels) > 1 else []


def _arrays(surface: Any, bare: bool) -> tuple[np.ndarray, np.ndarray]:
    """Positions (n,) and heights (rows, n) in the file's unit, NaN where one is missing.

    SurfaceTopography's first index runs along x, but an array without a format around
    it has rows, as maps have in Python.
    """
    if surface.dim == 1:
        x, heights = surface.positions_and_heights()
        heights = heights[None, :]
    else:
        heights = surface.heights() if bare else surface.heights().T
        x = surface.pixel_size[0] * np.arange(heights.shape[1])
    return np.asarray(x, float), np.ma.filled(np.ma.asarray(heights, float), np.nan)


def _scales(
    value: float | None, unit: str | None, asked: GivenUnits
) -> tuple[Scale | None, Scale | None]:
    """Of heights and of lengths: the file has one unit for both, or none."""
    if value is None:
        up, along = asked.heights, asked.length
        return (
            None if up is None else Scale(up, "height_unit or height_scale"),
            None if along is None else Scale(along, "length_unit"),
        )
    option = "height_unit" if asked.height_scale is None else "height_scale"
    needs = f"none: the file states its units ({unit})"
    require(asked.heights is None, option, asked.heights, needs)
    good = asked.length is None or asked.pixel is not None
    require(good, "length_unit", asked.length, needs)
    return Scale(value, str(unit)), Scale(value, str(unit))
