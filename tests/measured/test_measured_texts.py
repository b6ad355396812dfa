"""One surface in texts as instruments and offices write them: the same, or one line."""

import json
import warnings

import numpy as np
import pytest
from command_line import error_line, run
from instrument_files import COUNT, PERIOD, PIXEL, SIN, X, heights

import frictionjax as fx
from frictionjax.measured import MeasuredWarning, fit_profile, read_heights
from frictionjax.measured.cells import find_dialect
from frictionjax.measured.files import _text_of
from frictionjax.measured.units import cell_unit, metres

UM, NM = 1e6 * X, 1e9 * heights(1)[0]


def lines(*columns, by="\t", decimal=".", form="%.6f"):
    rows = zip(*columns, strict=True)
    text = "\n".join(by.join((form % v).replace(".", decimal) for v in row) for row in rows)
    return text + "\n"


MM, MICRO = UM / 1e3, NM / 1e3
ACROSS, UP = np.tile(UM, 3), np.repeat([0.0, 0.25, 0.5], COUNT)
SIZES = f"# Channel: Topo\n# Width: {1e6 * PIXEL * COUNT:g} \u00b5m\n# Height: 1 \u00b5m\n"
TEXTS = {
    "metres": "# x [m], z [m]\n" + lines(UM / 1e6, NM / 1e9, by=" ", form="%.9e"),
    "points": "X (\u00b5m)\tZ (nm)\n" + lines(UM, NM),
    "commas, semicolons": "X (\u00b5m);Z (nm)\n" + lines(UM, NM, by=";", decimal=","),
    "commas, tabs": "x [um]\tz [nm]\n" + lines(UM, NM, decimal=","),
    "commas, spaces": "x [um] z [nm]\n" + lines(UM, NM, by="  ", decimal=","),
    "table of an office": "X/mm,Z/um\n" + lines(MM, MICRO, by=",", form="%.9f"),
    "quoted": '"x_um","z_nm"\n'
    + lines(UM, NM, by='","', decimal=",", form='"%.6f"').replace('""', '"'),
    "whole numbers": "X/nm,Z/pm\n" + lines(1e3 * UM, 1e3 * NM, by=",", form="%.0f"),
    "a line of units": "Position;Height\n[\u00b5m];[nm]\n" + lines(UM, NM, by=";"),
    "comments": "# X units: um\n# Value units: nm\n" + lines(UM, NM),
    "one unit": "Units = micrometers\n" + lines(UM, MICRO, by=" "),
    "exponents of Fortran": "um nm\n" + lines(UM, NM, form="%.8e").replace("e", "D"),
    "angstrom, inches": "x (in);z (\u00c5)\n"
    + lines(UM / 25400, 10 * NM, by=";", form="%.9f"),
    "x y z": "x(um) y(um) z(nm)\n" + lines(ACROSS, UP, np.tile(NM, 3), by=" "),
    "Gwyddion": SIZES + "# Value units: nm\n" + lines(*np.tile(NM, (3, 1)).T),
    "one column": f"pixel size=0.25 um\nHeight [nm]\n{lines(NM)}",
    "empty cells at the end": "x (um),z (nm)\n" + lines(UM, NM, by=",") + ",,\n,\n",
    "the pixel of a trace": "pixel size=0.25 um\nx (um)\tz (nm)\n" + lines(UM, NM),
    "uneven": "x (um)\tz (nm)\n" + lines(np.delete(UM, [7, 91]), np.delete(NM, [7, 91])),
}


def written(folder, text, encoding="utf-8"):
    path = folder / "heights.txt"
    path.write_bytes(text.encode(encoding))
    return path


def read(path, **options):
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        measured = read_heights(path, **options)
    assert [str(w.message) for w in said] == [f"{path}: {n}" for n in measured.notes]
    return measured


def slopes(profile):
    """Steepest, by NumPy: compiles nothing."""
    phase = 2 * np.pi * np.outer(np.arange(4096) / 4096, np.arange(1, 3))
    waves = np.asarray(profile.sin) * np.cos(phase) - np.asarray(profile.cos) * np.sin(
        phase
    )
    along = waves @ (2 * np.pi * np.arange(1, 3))
    return along.max(), along.min()


EXACT = slopes(fx.profiles.Fourier([0.0, 0.0], SIN))


@pytest.mark.parametrize("name", TEXTS)
def test_the_same_surface_in_texts(name, tmp_path):
    measured = read(written(tmp_path, TEXTS[name]))
    assert not any("no unit" in note for note in measured.notes)
    found = fit_profile(measured, harmonics=2)
    assert found.period == pytest.approx(PERIOD, rel=1e-4)
    assert slopes(found.profile) == pytest.approx(EXACT, rel=1e-3)


@pytest.mark.parametrize(
    "encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "cp1252"]
)
def test_texts_in_any_encoding(encoding, tmp_path):
    measured = read(
        written(tmp_path, TEXTS["commas, tabs"].replace("um", "\u00b5m"), encoding)
    )
    assert measured.heights == pytest.approx(heights(1), abs=1e-15)
    first = lines(UM, NM)  # without a heading, the first row is the first line
    path = written(tmp_path, first, encoding)
    assert read(path, length_unit="um", height_unit="nm").x.size == COUNT


def test_bytes_that_are_no_text():
    assert _text_of(bytes(range(256))) is None
    assert _text_of(b"1 2\n3 4\n\x1a") == "1 2\n3 4\n"


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        # Commas that can be read both ways.
        ("1,234\n1,250\n2,250\n", {}, r'line 1 = .1,234.: needs decimal="\." where'),
        ("Height, nm\n1,5\n2,5\n", {}, 'line 2 = .1,5.: needs decimal="'),
        ("X/um,Z/nm\n0,10,1,55\n0,20,1,65\n", {}, '";" or a tab between'),
        ("0.5;1,5\n1.0;2,5\n", {}, "line 1 = .0.5;1,5.: needs one mark"),
        ("1.234,5\t2,5\n", {}, "line 1 = .*needs one mark"),
        # Units.
        ("X (um);Z\n0;1\n1;2\n", {}, "line 2, columns 1 and 2 = 'no unit': .*height_unit"),
        ("X;Z (nm)\n0.5;1\n1;2\n", {}, "line 2, columns 1 and 2 = 'no unit': .*length_uni"),
        ("X (um);Z (V)\n0;1\n1;2\n", {}, "line 1, column 2 = 'V': needs a unit of length"),
        ("Units: mm\nX (um);Z (um)\n0;1\n1;2\n", {}, "line 1 = 'mm': needs um"),
        (
            lines(MM, MICRO),
            {},
            "line 1, columns 1 and 2 = 'a mean slope of .*needs length_u",
        ),
        (lines(1e3 * UM, NM), {}, "= 'a trace of .* m': needs length_unit"),
        (
            lines(UM, NM),
            {"height_unit": "furlong"},
            "height_unit = 'furlong': needs a unit",
        ),
        (lines(NM), {"pixel": PIXEL}, "line 1, column 1 = 'a mean slope"),
        (
            lines(UM),
            {"height_unit": "nm", "height_scale": 1.0},
            "height_unit = 'nm': needs n",
        ),
        # Columns that are no heights.
        (
            lines(np.arange(COUNT), NM, form="%g"),
            {},
            "line 1, column 1 = '0, 1': needs pixel",
        ),
        (
            "n (px);z (nm)\n0;1\n1;2\n2;3\n3;4\n",
            {},
            "line 2, column 1 = '0, 1': needs pixel",
        ),
        (lines(UM, NM, NM), {"height_unit": "nm"}, "line 1 = '3 columns': needs 2"),
        (
            lines(np.arange(9), *np.ones((4, 9))),
            {"pixel": 1.0},
            "line 1, column 1 = '0, 1, ",
        ),
        ("0 BAD\nBAD 2\n1 3\n", {}, "line 2, column 1 = 'missing': needs a position"),
    ],
)
def test_what_is_not_certain_is_refused_by_line_and_column(
    text, options, message, tmp_path
):
    path = written(tmp_path, text)
    with pytest.raises(ValueError, match=message) as caught:
        read_heights(path, **options)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


def test_the_mark_of_decimals_can_be_said(tmp_path):
    path = written(tmp_path, "1,234\n1,250\n1,250\n")
    one = read(path, pixel=1.0, length_unit="um", height_unit="um", decimal=",")
    assert one.heights == pytest.approx(1e-6 * np.array([[1.234, 1.25, 1.25]]))
    path = written(tmp_path, "1,234\n2,250\n3,250\n")
    two = read(path, length_unit="um", height_unit="nm", decimal=".")
    assert two.heights == pytest.approx(1e-9 * np.array([[234, 250, 250]]))
    with pytest.raises(ValueError, match=r"decimal = ';': needs a point"):
        read_heights(path, decimal=";")


@pytest.mark.parametrize(
    ("rows", "separator", "decimal"),
    [
        (["0.5,1.5"], ",", "."),
        (["1e-6,2"], ",", "."),
        (["1,-5"], ",", "."),
        (["1, 5"], ",", "."),
        (["1,2,3"], ",", "."),
        (["1,5 2,5"], None, ","),
        (["1,5\t2"], "\t", ","),
        (["1,05"], None, ","),
        (["2", "2,5"], None, ","),
        (["1;2"], ";", "."),
        (["2026-01-02", "1\t2"], "\t", "."),
    ],
)
def test_dialects(rows, separator, decimal):
    assert find_dialect(list(enumerate(rows, 1)), None) == (separator, decimal)


@pytest.mark.parametrize(
    ("cell", "unit"),
    [
        ("Z (nm)", "nm"),
        ("X [\u00b5m]", "\u00b5m"),
        ("X/mm", "mm"),
        ("height_m", "m"),
        ("Distance, um", "um"),
        ("Lateral um", "um"),
        ("Phase (rad)", "rad"),
        ("Profile A", None),
        ("measured in", None),
        ("Position", None),
        ("N/A", None),
    ],
)
def test_units_of_headings(cell, unit):
    assert cell_unit(cell) == unit


def test_units():
    assert {
        metres(u) for u in ("um", "\u00b5m", "\u03bcm", "micron", "Micrometres", "UM")
    } == {1e-6}
    assert metres("Mm") is metres("V") is metres("") is None
    assert metres("in") == metres("inches") == 0.0254


def test_no_unit_at_all_is_said(tmp_path):
    path = written(tmp_path, lines(X, heights(1)[0], form="%.9e"))
    with pytest.warns(
        MeasuredWarning, match=r"txt: line 1, columns 1 and 2: no unit of len"
    ):
        measured = read_heights(path)
    assert measured.x == pytest.approx(X)


def test_a_unit_given_goes_before_the_file_and_is_noted(tmp_path):
    path = written(tmp_path, "X (um);Z (um)\n" + lines(UM, NM, by=";"))
    measured = read(path, height_unit="nm")
    assert measured.heights == pytest.approx(heights(1), abs=1e-15)
    assert measured.notes[0].startswith("line 1, column 2 says um: height_unit")


def test_a_count_of_samples_takes_the_pixel(tmp_path):
    path = written(tmp_path, "n\tz (nm)\n" + lines(np.arange(COUNT), NM, form="%.9g"))
    assert read(path, pixel=PIXEL).x == pytest.approx(X)
    assert read(path, pixel=0.25, length_unit="um").x[-1] == pytest.approx(X[-1])


def with_cells(cells, text=None, by="\t"):
    """A trace some of whose heights read otherwise."""
    rows = [row.split("\t") for row in (text or lines(UM, NM)).splitlines()]
    for index, cell in cells.items():
        rows[index][1] = cell
    return "x (um)" + by + "z (nm)\n" + "\n".join(by.join(row) for row in rows) + "\n"


@pytest.mark.parametrize(
    "cell", ["NaN", "BAD", "", "---", "-32768", "1e38", "-9999", "inf"]
)
@pytest.mark.parametrize("by", ["\t", ";"])
def test_missing_samples_are_filled_and_noted(cell, by, tmp_path):
    path = written(tmp_path, with_cells({99: cell, 100: cell}, by=by))
    measured = read(path)
    assert measured.heights.shape == (1, COUNT)
    assert np.max(np.abs(measured.heights - heights(1))) < 0.02 * np.ptp(heights(1))
    last = "2 of 320 heights missing, first line 101, column 2: filled by straight lines, "
    assert measured.notes[-1] == last + "over 2 samples at most"
    if cell in ("-32768", "-9999"):
        assert measured.notes[0].startswith(
            f"line 101, column 2 = {cell}: taken as missing"
        )


@pytest.mark.parametrize("cell", ["BAD", ""])
def test_a_first_row_without_a_height_is_not_lost(cell, tmp_path):
    measured = read(written(tmp_path, with_cells({0: cell})))
    assert measured.notes == ("samples missing at the ends, cut off: 1",)
    assert measured.x[0] == pytest.approx(PIXEL)
    text = "pixel size=1 um\ndata unit=nm\nBAD BAD 3 4\n" + "1 2 3 4\n" * 20
    with pytest.raises(ValueError, match="line 3, column 1 = 'missing, with 50%'"):
        read_heights(written(tmp_path, text))


def test_long_gaps_are_refused(tmp_path):
    """40 samples a period: 4 are a tenth."""
    short = with_cells({100 + i: "BAD" for i in range(4)})
    assert "over 4 samples" in read(written(tmp_path, short)).notes[0]
    path = written(tmp_path, with_cells({100 + i: "BAD" for i in range(6)}))
    with pytest.raises(ValueError, match=r"line 102, column 2 = '1.5e-06 m of missing"):
        read_heights(path)
    path = written(tmp_path, with_cells(dict.fromkeys(range(1, 300, 4), "BAD")))
    with pytest.raises(ValueError, match="missing, with 23%': needs at most 10%"):
        read_heights(path)


def test_values_inside_the_others_are_no_sentinels(tmp_path):
    wide = np.where(np.arange(COUNT) % 40 == 3, -9999.0, 1e4 * np.sin(UM))
    path = written(tmp_path, "x (um)\tz (pm)\n" + lines(UM, wide))
    assert read(path).notes == ()


def test_the_shell_reads_texts_as_python_does(tmp_path):
    path = written(tmp_path, lines(UM, NM, by=";", decimal=","))
    assert "needs --length-unit" in error_line(run("friction", "--heights", path))
    units = ["--length-unit", "um", "--height-unit", "nm", "--harmonics", "2"]
    result = run("friction", "--heights", path, *units, "--json")
    assert result.exit_code == 0, result.stderr
    found = json.loads(result.stdout)
    steepest = found["omega_plus"], found["omega_minus"]
    assert steepest == pytest.approx(EXACT, rel=1e-3)
    holes = written(tmp_path, with_cells({99: "BAD"}))
    result = run("friction", "--heights", holes, "--harmonics", "2")
    assert "1 of 320 heights missing, first line 101, column 2" in result.stdout
    said = error_line(run("friction", "--length-unit", "um"))
    assert "--length-unit = 'um': needs --heights FILE" in said
