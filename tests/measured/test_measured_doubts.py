"""Files whose meaning cannot be known: asked about in one line, never guessed."""

import warnings

import numpy as np
import pytest
from command_line import error_line, run
from instrument_files import COUNT, PERIOD, PIXEL, X, heights

from frictionjax.measured import MeasuredWarning, fit_profile, read_heights
from frictionjax.measured.axes import axis_of
from frictionjax.measured.cells import find_dialect

UM, NM = 1e6 * X, 1e9 * heights(1)[0]


def lines(*columns, by=";", form="%.6f"):
    rows = zip(*columns, strict=True)
    return "\n".join(by.join(form % v for v in row) for row in rows) + "\n"


TRACE = lines(UM, NM)
MAP = lines(*(NM + 20 * np.arange(5)[:, None] ** 2).T)
SIZE = "pixel size=0.25 um\nvalue units: nm\n"


def written(folder, text):
    path = folder / "heights.txt"
    path.write_text(text, encoding="utf-8")
    return path


def read(path, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeasuredWarning)
        return read_heights(path, **options)


def refused(folder, text, message, **options):
    path = written(folder, text)
    with pytest.raises(ValueError, match=message) as caught:
        read(path, **options)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "header",
    [
        "pixel size (um)=0.25\nvalue units: nm\n",
        "# Pixel size [um]: 0.25\n# Value units: nm\n",
        "pixel width (nm): 250\nheight conversion factor [nm]: 1\n",
        "pixel_size_um = 0.25\nheight conversion factor (nm/unit)=1\n",
        "pixel size in um: 0.25\nheight conversion factor (-> nm)=1\n",
        "X unit: um\npixel size: 0.25\nZ unit: nm\n",
        "pixel size=0,25 um\nheight conversion factor=1 nm\n",
        "pixel size=0.25 um/px\nZ-Einheit: nm\n",
        "pixel size X=0.25 um\npixel size Y=9 um\nvalue units: nm\n",
        f"Width (um): {0.25 * COUNT}\nvalue units: nm\n",
    ],
)
def test_units_in_keys_count(header, tmp_path):
    found = read(written(tmp_path, header + MAP))
    assert found.x == pytest.approx(X)
    assert found.heights[0] == pytest.approx(heights(1)[0], abs=1e-15)


@pytest.mark.parametrize(
    ("header", "message"),
    [
        (
            "pixel size=0.25\nvalue units: nm\n",
            "line 1, pixel size = '0.25': .*length_unit",
        ),
        (
            "value units: nm\nx pixel size=2.5e-7\n",
            "line 2, x pixel size = '2.5e-7': needs",
        ),
        (
            "pixel size=1 um\nheight conversion factor=1\n",
            "line 2, height conversion factor = '1': needs its unit, .*height_scale",
        ),
        (
            "pixel size (um)=250 nm\nvalue units: nm\n",
            "= '250 nm': needs one unit: its key",
        ),
        ("pixel size=1,250 um\nvalue units: nm\n", "'1,250 um': needs a decimal point"),
        (
            "pixel size=1 um\npixel width=2 um\nvalue units: nm\n",
            "line 2, pixel width = '2 um': needs 1 um as line 1",
        ),
    ],
)
def test_sizes_without_a_unit_are_asked_about(header, message, tmp_path):
    refused(tmp_path, header + MAP, message)


def test_options_give_the_unit_of_a_size(tmp_path):
    text = "pixel size=0.25\nheight conversion factor=7\n" + MAP
    found = read(written(tmp_path, text), length_unit="um", height_unit="nm")
    assert found.x == pytest.approx(X)
    assert found.heights[0] == pytest.approx(heights(1)[0], abs=1e-15)


GROUPED = [f"{round(250 * i)}\t{round(10 * z + 20000):,}" for i, z in enumerate(NM)]


def test_commas_of_thousands_or_decimals_are_asked_about(tmp_path):
    text = "X (nm)\tZ (pm)\n" + "\n".join(GROUPED) + "\n"
    refused(tmp_path, text, r"line 2 = .*needs decimal=\",\" where .*--decimal")
    true = (np.round(10 * NM + 20000) * 1e-12)[None]
    for mark, factor in ((".", 1.0), (",", 1e-3)):
        found = read(written(tmp_path, text), decimal=mark)
        assert found.heights == pytest.approx(factor * true)
    said = error_line(run("friction", "--heights", written(tmp_path, text)))
    assert "--decimal" in said


@pytest.mark.parametrize(
    ("rows", "mark"),
    [
        (["0;900", "1,250;1,100"], None),
        (["20,292 30,111", "20,392 30,112"], None),
        (["1,234,567;2,000"], None),
        (['"1,234","2,345"'], None),
        (["-1,250\t1"], None),
        (["0,123;2"], ","),
        (["1,250;1,25"], ","),
        (["1290000,875;1,250"], ","),
    ],
)
def test_three_digits_behind_each_comma_decide_nothing(rows, mark):
    lines = list(enumerate(rows, 1))
    if mark is None:
        with pytest.raises(ValueError, match=r"line \d = .*where they part thousands"):
            find_dialect(lines, None)
        assert None not in [find_dialect(lines, ".").numbers(row) for row in rows]
    else:
        assert find_dialect(lines, None).decimal == mark


AXES = np.vstack([np.r_[0, UM], np.c_[0.5 * np.arange(5), np.tile(NM, (5, 1))]])
ROWS = lines(*AXES[1:].T)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            SIZE + lines(*AXES.T),
            r"line 3 = '0, 0, 0.25, 0.5, \.\.\.': needs heights: these",
        ),
        (SIZE + ";" + lines(*AXES.T)[9:], "line 3 = "),
        (SIZE + lines(*AXES[:, 1:].T), r"line 3 = '0, 0.25, 0.5"),
        (
            SIZE + "y\\x;" + ";".join(f"{v:.2f}" for v in UM) + "\n" + ROWS,
            "column 1, lines 4",
        ),
        (
            SIZE + lines(10 + np.arange(5), *np.tile(NM, (5, 1)).T),
            "column 1, lines 3 on = '10, 1",
        ),
        (SIZE + lines(*np.vstack([np.round(UM, 1), NM, NM]).T), "line 3 = '0, 0.2, 0.5"),
        (SIZE + lines(*np.c_[np.arange(5)[::-1], AXES[1:, 1:]].T), "column 1, lines 3 on"),
    ],
)
def test_positions_in_a_map_are_no_heights(text, message, tmp_path):
    refused(tmp_path, text, message)


def test_heights_that_rise_are_no_positions():
    rng = np.random.default_rng(5)
    x, y = np.arange(40), np.arange(30)[:, None]
    for heights_ in (
        x + 3.0 * y,
        np.sin(0.3 * x) + 2.0 * y,
        np.sin(0.3 * x + 0.1 * y) + 0.01 * rng.normal(size=(30, 40)),
        np.round(np.sin(0.1 * x) + 1.0 * y[:4] + 0.1 * x),
        rng.normal(size=(3, 40)),
    ):
        assert axis_of(heights_) is None


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("X (um);Z (nm);Z2 (nm)\n" + lines(UM, NM, NM), {"pixel": PIXEL}, r"'X \(um\)': n"),
        ("N;A (nm);B (nm)\n" + lines(UM + 7, NM, NM), {"pixel": PIXEL}, "column 1 = 'N'"),
        (
            "Z (nm);X (um)\n" + lines(UM, NM),
            {},
            r"line 1, column 2 = 'X \(um\)': needs pos",
        ),
        (
            "# X units: um\nNo.;Z (nm)\n" + lines(np.arange(COUNT), NM),
            {},
            "'No.' is a count",
        ),
        (
            "index;Z (nm)\n" + lines(100 + np.arange(COUNT), NM),
            {},
            "needs pixel, .*'index'",
        ),
        ("#;Z (nm)\n" + lines(10 * np.arange(COUNT), NM), {"pixel": PIXEL}, "line 3, col"),
    ],
)
def test_columns_are_what_their_heading_says(text, options, message, tmp_path):
    refused(tmp_path, text, message, **options)


def test_an_index_takes_the_pixel_of_the_file(tmp_path):
    text = "pixel size=0.25 um\nNo.;Z (nm)\n" + lines(100 + np.arange(COUNT), NM)
    assert np.diff(read(written(tmp_path, text)).x) == pytest.approx(PIXEL)


AMOUNTS = ["# Rz;0.3 um", "# Radius;2 um", "# Length;5 mm", "#end; in", "# 5 um;0.3 um"]


@pytest.mark.parametrize("amount", AMOUNTS)
def test_amounts_in_comments_head_no_columns(amount, tmp_path):
    for head in ("# X unit: um\nX;Z (nm)\n", "# X (um);Z (nm)\n"):
        for text in (head + TRACE + amount + "\n", amount + "\n" + head + TRACE):
            found = read(written(tmp_path, text))
            assert found.heights == pytest.approx(heights(1), abs=1e-15)
    message = "needs height_unit"
    refused(tmp_path, "# X unit: um\n" + amount + "\nX;Z\n" + TRACE, message)
    footer = "X (um);Z (nm)\n" + TRACE + "# Value units: um\n"
    refused(tmp_path, footer, "needs nm as line 1, column 2")


@pytest.mark.parametrize(
    "header",
    [
        "# XUNIT um\n# ZUNIT nm\n",
        "# xunit=um\n# zunit=nm\n",
        "# UnitX: um\n# UnitZ: nm\n",
        "# X-Einheit: um\n# Z-Einheit: nm\n",
        "# unit x = um, unit z = nm\n",
        "# X Unit: um; Z Unit: nm\n",
        "# um / nm\n",
        "X (um);Z (nm);\n",
    ],
)
def test_units_however_they_are_stated(header, tmp_path):
    found = read(written(tmp_path, header + TRACE))
    assert found.x == pytest.approx(X)
    assert found.heights == pytest.approx(heights(1), abs=1e-15)


@pytest.mark.parametrize(
    ("line", "options", "message"),
    [
        ("um\tnm\tpos\theight", {}, "line 1 = .um.*needs length_unit and height_unit: its"),
        ("# lateral: um, vertical: same", {}, "line 1 = '# lateral"),
        ("# UNITS: X=um Z=nm", {}, "line 1 = "),
        ("# scanned over 80 microns", {"length_unit": "um"}, "needs height_unit: its unit"),
        ("# all in [nm], said the operator", {}, "line 1 = "),
    ],
)
def test_units_that_nobody_understands_are_shown(line, options, message, tmp_path):
    small = lines(1e-3 * UM, 1e-3 * NM, form="%.9f")
    refused(tmp_path, line + "\n" + small, message, **options)


def test_the_shell_asks_and_names_the_file(tmp_path):
    high = NM.copy()
    high[99] = 1e6
    path = written(tmp_path, "X (um);Z (nm)\n" + lines(UM, high))
    said = error_line(run("friction", "--heights", path))
    assert f"{path}: line 101, column 2 = '1000000': needs outliers=" in said
    assert fit_profile(read(path, outliers="missing")).period == pytest.approx(
        PERIOD, rel=1e-3
    )
    with pytest.raises(ValueError, match="outliers = 'drop': needs"):
        read(path, outliers="drop")
    plain = written(
        tmp_path, "X (um);Z (um)\n" + TRACE
    )  # heights a thousand times too high
    assert f"{plain}: bristle.angle" in error_line(run("friction", "--heights", plain))
    few = written(tmp_path, "X (um);Z (nm)\n" + lines(UM[:5], NM[:5]))
    assert f"{few}: x = '5 positions'" in error_line(run("friction", "--heights", few))
