"""One surface in the formats of instruments: the same friction, or one line."""

import sys
import warnings

import numpy as np
import pytest
from command_line import error_line, run
from instrument_files import COUNT, FORMATS, PERIOD, PIXEL, ROWS, SIN, gwy, heights, sur

import frictionjax as fx
from frictionjax.measured import MeasuredWarning, fit_profile, read_heights

BRISTLE = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)


@pytest.fixture(autouse=True, scope="module")
def _readers():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pytest.importorskip("SurfaceTopography")


def read(path, **options):
    """What is read, and what is said."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        measured = read_heights(path, **options)
    assert [str(w.message) for w in said] == [f"{path}: {n}" for n in measured.notes]
    return measured


@pytest.mark.parametrize("name", FORMATS)
def test_the_same_surface_in_formats_of_instruments(name, tmp_path):
    path = tmp_path / f"grooves.{name}"
    FORMATS[name](path, heights())
    measured = read(path)
    assert measured.heights.shape == (ROWS, COUNT)
    assert measured.x == pytest.approx(PIXEL * np.arange(COUNT), rel=1e-6)
    found = fit_profile(measured, harmonics=2)
    assert found.period == pytest.approx(PERIOD, rel=1e-4)
    ours = fx.friction(found.profile, BRISTLE)
    exact = fx.friction(fx.profiles.Fourier([0.0, 0.0], SIN), BRISTLE)
    for side in ("rho_plus", "rho_minus"):
        assert getattr(ours, side) == pytest.approx(float(getattr(exact, side)), rel=1e-3)


def test_the_channel_of_heights_is_named(tmp_path):
    gwy(tmp_path / "two.gwy", heights())
    (note,) = read(tmp_path / "two.gwy").notes
    assert note == "channel Topography, of 2 (Topography, Backwards)"


@pytest.mark.parametrize(("run", "fills"), [(slice(50, 53), True), (slice(50, 62), False)])
def test_masked_samples_are_missing_ones(run, fills, tmp_path):
    """Of 40 samples a period."""
    gone = np.zeros((ROWS, COUNT), bool)
    gone[1, run] = True
    sur(tmp_path / "holes.sur", heights(), gone)
    if not fills:
        with pytest.raises(ValueError, match=r"row 1, sample 50 = .*a tenth of the period"):
            read_heights(tmp_path / "holes.sur")
        return
    measured = read(tmp_path / "holes.sur")
    assert measured.notes[0].startswith("3 of 960 heights missing, first row 1, sample 50")
    assert np.max(np.abs(measured.heights - heights())) < 0.02 * np.ptp(heights())


@pytest.mark.parametrize("shape", ["map", "trace"])
def test_arrays_without_units_ask_for_them(shape, tmp_path):
    """Rows of an array are rows of a map, as in Python."""
    z = 1e9 * (heights() if shape == "map" else heights(1)[0])
    path = tmp_path / "bare.npy"
    np.save(path, z)
    with pytest.raises(ValueError, match=r"bare.npy: pixel = 'nothing'"):
        read_heights(path)
    with pytest.raises(
        ValueError, match=r"mean slope of .*needs length_unit and height_un"
    ):
        read_heights(path, pixel=PIXEL)
    measured = read(path, pixel=1e6 * PIXEL, length_unit="um", height_unit="nm")
    assert measured.heights == pytest.approx(1e-9 * np.atleast_2d(z), rel=1e-12)
    assert measured.x[-1] == pytest.approx(PIXEL * (COUNT - 1))


@pytest.mark.parametrize("unit", ["nm", "\u00b5m", "mm"])
def test_positions_of_an_uneven_trace_are_read(unit, tmp_path):
    from SurfaceTopography import NonuniformLineScan

    size = {"nm": 1e9, "\u00b5m": 1e6, "mm": 1e3}[unit]
    x, z = (np.delete(v, [7, 91]) for v in (PIXEL * np.arange(COUNT), heights(1)[0]))
    NonuniformLineScan(size * x, size * z, unit=unit).to_netcdf(tmp_path / "n.nc")
    measured = read(tmp_path / "n.nc")
    assert measured.x == pytest.approx(x)
    assert measured.heights == pytest.approx(z[None], abs=1e-15)
    assert fit_profile(measured, harmonics=2).period == pytest.approx(PERIOD, rel=1e-4)
    with pytest.raises(ValueError, match="pixel = 1e-06: needs none: the file has posit"):
        read_heights(tmp_path / "n.nc", pixel=1e-6)


def test_positions_in_an_array_are_no_heights(tmp_path):
    axes = np.vstack(
        [np.r_[0, PIXEL * np.arange(COUNT)], np.c_[np.arange(ROWS), heights()]]
    )
    np.save(tmp_path / "axes.npy", axes)
    with pytest.raises(ValueError, match=r"axes.npy: first row = .*needs heights"):
        read_heights(tmp_path / "axes.npy", pixel=PIXEL)


def test_units_of_the_file_are_not_said_twice(tmp_path):
    FORMATS["os3d"](tmp_path / "um.os3d", heights())
    for options in ({"height_unit": "nm"}, {"height_scale": 1e-9}, {"length_unit": "m"}):
        with pytest.raises(ValueError, match=f"{next(iter(options))} = .*: needs none"):
            read_heights(tmp_path / "um.os3d", **options)
    assert read(tmp_path / "um.os3d", pixel=1e-6).x[1] == 1e-6


@pytest.mark.parametrize(
    "content",
    [
        bytes(range(256)) * 8,  # 1024 samples of 16 bits: 32 x 32, as a map of the Earth
        b"DIGITAL SURF" + b"\0" * 30,
        b"\x89HDF\r\n\x1a\n" + b"\0" * 64,
        b"PK\x03\x04" + b"\0" * 64,
        b"\x1f\x8b" + b"\0" * 64,
    ],
)
def test_files_that_nobody_reads_are_refused_in_one_line(content, tmp_path):
    path = tmp_path / "odd.dat"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"odd\.dat: ") as caught:
        read_heights(path, pixel=1.0, height_unit="m")
    assert "\n" not in str(caught.value)


def test_without_the_extra_a_line_says_which(tmp_path, monkeypatch):
    FORMATS["sdf"](tmp_path / "a.sdf", heights())
    monkeypatch.setitem(sys.modules, "SurfaceTopography.IO", None)
    with pytest.raises(ValueError, match=r'pip install "frictionjax\[instruments\]"'):
        read_heights(tmp_path / "a.sdf")
    said = error_line(run("friction", "--heights", tmp_path / "a.sdf"))
    assert "frictionjax[instruments]" in said


def test_the_shell_reads_them_and_prints_the_notes(tmp_path):
    gwy(tmp_path / "two.gwy", heights())
    result = run("friction", "--heights", tmp_path / "two.gwy", "--harmonics", "2")
    assert result.exit_code == 0, result.stderr
    assert "two.gwy: channel Topography, of 2" in result.stdout
    assert MeasuredWarning.__name__ not in result.stderr
