"""Which columns of a text file are positions, which are heights."""

from typing import NamedTuple

import numpy as np

from .._checks import require
from .axes import axis_of
from .entries import Size, Stated
from .headings import Headings, read_headings
from .samples import HeightSamples
from .scales import GivenUnits, Scale, completed, require_metres, scale_of
from .sentinels import without_sentinels
from .table import NumberTable, read_numbers

_COUNTS = "0, 1, 2, ..."


class _Raw(NamedTuple):
    """Samples in the file's units, and the m per unit of their positions, where known."""

    samples: HeightSamples
    length: Scale | None
    place: str


def read_text(text: str, asked: GivenUnits) -> HeightSamples:
    """Heights of a text file, NaN where one is missing; see `read_heights`."""
    table = read_numbers(text, asked.decimal)
    columns, first = table.block.shape[1], int(table.lines[0])
    headings = read_headings(table.said, columns, table.dialect, first)
    mapped = headings.pixel is not None or bool(headings.sizes)
    if columns == 2 and not (mapped and not _are_positions(table.block[:, 0])):
        raw = _pairs(table, headings, asked)
    elif columns == 3 and not mapped and _is_grid(table.block):
        raw = _grid(table, headings, asked)
    else:
        raw = _map(table, headings, asked)
    return _in_metres(raw, headings, asked)


def _are_positions(x: np.ndarray) -> bool:
    """Whether a column rises all along, which no map of two samples a row does."""
    return x.size >= 8 and bool(np.all(np.diff(x) > 0))


def _in_metres(raw: _Raw, headings: Headings, asked: GivenUnits) -> HeightSamples:
    samples = without_sentinels(raw.samples, asked.outliers)
    # A factor is for whatever unit the heights have, as the user's is.
    factor = headings.factor
    free = factor is not None or asked.height_scale is not None
    stated = [] if free else headings.height
    value = asked.heights
    if factor is not None and value is None:
        needs = "its unit, as 1 nm, or height_unit or height_scale"
        require(factor.unit is not None, factor.place, factor.text, needs)
        value = factor.value * (factor.unit or 1.0)
    height, notes = scale_of(value, stated, "height_unit or height_scale")
    _require_read(raw.length, height, headings.unread)
    along, up, unsaid = completed(raw.length, height, raw.place)
    x, heights = along * samples.x, up * samples.heights
    if unsaid:
        require_metres(x, heights, raw.place)
    return samples._replace(x=x, heights=heights, notes=[*samples.notes, *notes, *unsaid])


def _require_read(
    length: Scale | None, height: Scale | None, unread: Stated | None
) -> None:
    """Raise where a unit is missing, and a line names one in a way nobody understands."""
    options = [("length_unit", length), ("height_unit", height)]
    missing = " and ".join(name for name, scale in options if scale is None)
    if missing and unread is not None:
        needs = f"{missing}: its unit is not understood"
        require(False, unread.place, unread.text[:60], needs)


def _pairs(table: NumberTable, headings: Headings, asked: GivenUnits) -> _Raw:
    """A trace: positions and heights."""
    x, line = table.block[:, 0], int(table.lines[0])
    samples = _trace(table, x, table.block[:, 1], column=2)
    swapped = headings.is_position(1) and headings.is_height(0)
    said = headings.names[1] if swapped else ""
    place = f"line {headings.named}, column 2"
    require(not swapped, place, said, "positions first, then heights")
    index = headings.is_index(0)
    unit = asked.length is not None or _are_lengths(headings.length)
    if index or (_counts(x) and (asked.pixel is not None or not unit)):
        return _counted(samples, headings, asked, line)
    needs = "none: the file has a column of positions"
    require(asked.pixel is None, "pixel", asked.pixel, needs)
    _require_positions(x, table.lines, column=1)
    scale, notes = scale_of(asked.length, headings.length, "length_unit")
    samples = samples._replace(notes=notes)
    return _Raw(samples, scale, f"line {line}, columns 1 and 2")


def _counted(
    samples: HeightSamples, headings: Headings, asked: GivenUnits, line: int
) -> _Raw:
    """A trace whose first column counts samples: the pixel says how far they are."""
    x, place = samples.x, f"line {line}, column 1"
    pixel = _pixel(headings, asked, x.size)
    needs = f"pixel, the distance of samples, for a count {_COUNTS}; or length_unit"
    if headings.is_index(0):
        needs = f"pixel, the distance of samples: {headings.names[0]!r} is a count"
    require(pixel is not None, place, ", ".join(f"{v:g}" for v in x[:2]), needs)
    assert pixel is not None
    skips = np.flatnonzero(np.diff(x) != 1) + 1
    if skips.size:
        place = f"line {samples.lines[0, skips[0]]}, column 1"
        require(False, place, float(x[skips[0]]), "counts one after the other")
    note = f"{place}: counts samples, of {pixel.value:.6g} m each"
    samples = samples._replace(x=x * pixel.value, notes=[note])
    return _Raw(samples, Scale(1.0, pixel.said), f"line {line}, column 2")


def _are_lengths(stated: list[Stated]) -> bool:
    """Whether the file gives a unit of positions that is one: samples are none."""
    return bool(stated) and not any(
        s.text.lower().startswith(("px", "pixel", "sample", "count")) for s in stated
    )


def _counts(x: np.ndarray) -> bool:
    first = x[0]
    return first in (0, 1) and x.size > 3 and np.array_equal(x, first + np.arange(x.size))


def _trace(
    table: NumberTable, x: np.ndarray, heights: np.ndarray, column: int
) -> HeightSamples:
    lines = table.lines[None, :]
    return HeightSamples(x, heights[None, :], [], lines, np.full_like(lines, column))


def _require_positions(x: np.ndarray, lines: np.ndarray, column: int) -> None:
    lost = np.flatnonzero(np.isnan(x))
    if lost.size:
        place = f"line {lines[lost[0]]}, column {column}"
        require(False, place, "missing", "a position")
    back = np.flatnonzero(np.diff(x) <= 0) + 1
    if back.size:
        place = f"line {lines[back[0]]}, column {column}"
        require(False, place, float(x[back[0]]), "increasing positions")


def _is_grid(block: np.ndarray) -> bool:
    """Whether columns are x, y and z on a grid, row by row or column by column."""
    x, y = block[:, 0], block[:, 1]
    if np.isnan(block[:, :2]).any():
        return False
    across, up = np.unique(x), np.unique(y)
    size = across.size * up.size
    return across.size > 3 and size == len(block) == len(np.unique(block[:, :2], axis=0))


def _grid(table: NumberTable, headings: Headings, asked: GivenUnits) -> _Raw:
    """A map: x, y and z in three columns."""
    order = np.lexsort((table.block[:, 0], table.block[:, 1]))
    rows = np.unique(table.block[:, 1]).size
    across, _, heights = table.block[order].T.reshape(3, rows, -1)
    lines = table.lines[order].reshape(rows, -1)
    needs = "none: the file has positions"
    require(asked.pixel is None, "pixel", asked.pixel, needs)
    place = f"line {int(table.lines[0])}, columns 1 to 3"
    scale, notes = scale_of(asked.length, headings.length, "length_unit")
    note = f"{place}: x, y and z, {rows} rows of {across.shape[1]}"
    samples = HeightSamples(
        across[0], heights, [note, *notes], lines, np.full_like(lines, 3)
    )
    return _Raw(samples, scale, place)


def _map(table: NumberTable, headings: Headings, asked: GivenUnits) -> _Raw:
    """A map, one row a line; or a trace in one column."""
    block, line = table.block, int(table.lines[0])
    place = f"line {line}, column 1"
    one = block.shape[1] == 1
    heights = block.T if one else block
    for key, size in zip("hw", heights.shape, strict=True):
        said = headings.sizes.get(key, size)
        require(said == size, key, said, f"{size}, the size of the block of numbers")
    pixel = _pixel(headings, asked, heights.shape[1])
    if block.shape[1] == 3 and pixel is None:
        needs = "2 (positions, heights), x y z on a grid, or pixel for a map"
        require(False, f"line {line}", "3 columns", needs)
    needs = "the distance of samples in m, or in length_unit"
    require(pixel is not None, "pixel", "nothing", needs)
    if not one:
        _require_heights(table, headings)
    assert pixel is not None
    lines, columns = np.broadcast_arrays(
        table.lines[:, None], np.arange(1, block.shape[1] + 1)
    )
    if one:
        lines, columns = lines.T, columns.T
    x = pixel.value * np.arange(heights.shape[1])
    samples = HeightSamples(x, heights, [], lines, columns)
    return _Raw(samples, Scale(1.0, pixel.said), place)


def _require_heights(table: NumberTable, headings: Headings) -> None:
    """Raise where a row or a column of a map is one of positions, or counts."""
    block, line = table.block, int(table.lines[0])
    for column, name in enumerate(headings.names):
        good = not headings.is_position(column) and not headings.is_index(column)
        needs = "columns of heights alone, beside pixel"
        require(good, f"line {headings.named}, column {column + 1}", name, needs)
    counts = _counts(block[:, 0]) or _counts(block[0])
    needs = "heights: numbers of rows or columns are none"
    require(not counts, f"line {line}, column 1", _COUNTS, needs)
    axis = axis_of(block)
    if axis is not None:
        place = f"line {line}" if axis == 0 else f"column 1, lines {line} on"
        values = block[0] if axis == 0 else block[:, 0]
        said = ", ".join(f"{v:g}" for v in values[:4])
        needs = "heights: these go evenly, as positions do, unlike others; take them out"
        require(False, place, f"{said}, ...", needs)


def _pixel(headings: Headings, asked: GivenUnits, count: int) -> Scale | None:
    """Distance of samples in m: the user's, the file's, or from its width."""
    pixel = asked.pixel_in_metres
    if pixel is not None:
        return Scale(pixel, "pixel")
    if headings.pixel is not None:
        return Scale(_in_file(headings.pixel, headings, asked), "the pixel size")
    if headings.width is None:
        return None
    return Scale(_in_file(headings.width, headings, asked) / count, "the width")


def _in_file(size: Size, headings: Headings, asked: GivenUnits) -> float:
    """A size in m, by its own unit, or else by that of lengths."""
    if size.unit is not None:
        return size.value * size.unit
    scale, _ = scale_of(asked.length, headings.length, "length_unit")
    needs = f"its unit, as {size.text} um; or length_unit, or pixel"
    require(scale is not None, size.place, size.text, needs)
    assert scale is not None
    return size.value * scale.value
