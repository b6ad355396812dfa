"""Measured surfaces: what files may look like, and what comes out of real ones."""

from pathlib import Path

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.measured import (
    Measured,
    MeasuredWarning,
    fit_profile,
    read_heights,
    row_coefficients,
)
from frictionjax.profiles.steepest import slopes_of_waves

DATA = Path(__file__).parents[3] / "shared" / "data"
BRISTLE = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)


def written(folder, text):
    path = folder / "heights.txt"
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    "fit",
    [
        lambda noise: fit_profile(noise, harmonics=2),
        lambda noise: fx.profiles.Fourier.from_heights(noise.x, noise.heights[0]),
    ],
)
def test_a_warning_of_a_fit_points_to_the_line_that_asked_for_it(fit):
    x = np.linspace(0, 1e-3, 400)
    noise = Measured(x, np.random.default_rng(1).normal(size=(1, 400)))
    with pytest.warns(fx.profiles.SlopesUndetermined) as caught:
        fit(noise)
    assert [one.filename for one in caught] == [__file__]


@pytest.mark.parametrize(
    "text",
    [
        "x [m]\tz [m]\n0 1.5   \n1e-6 2.5\t\n3e-6 -0.5\n",
        "x (m), height (um)\n# comment\n0,1.5\n1e-6,2.5\n\n3e-6,-0.5,\n",
        "x/m Height/nm\n0; 1.5\n# in between\n1e-6; 2.5\n3e-6; -0.5",
    ],
)
def test_two_columns(text, tmp_path):
    found = read_heights(written(tmp_path, text), height_scale=2.0)
    assert found.x.tolist() == [0.0, 1e-6, 3e-6]
    assert found.heights.tolist() == [[3.0, 5.0, -1.0]]
    assert found.notes == ()


MAP = "h=2 w=3\npixel size=2e-006 m\ndata unit=rad\nheight conversion factor (-> m)=1e-8\n"
ROWS = "1 2 3 \n4 5 6 \n"


def test_map(tmp_path):
    found = read_heights(written(tmp_path, MAP + ROWS))
    assert found.x == pytest.approx([0.0, 2e-6, 4e-6])
    assert found.heights == pytest.approx(np.array([[1, 2, 3], [4, 5, 6]]) * 1e-8)


def test_a_map_of_two_columns_is_told_by_its_pixel(tmp_path):
    found = read_heights(written(tmp_path, "pixel size=1 um\nUnits: um\n1 2\n3 4\n"))
    assert found.heights.tolist() == [[1e-6, 2e-6], [3e-6, 4e-6]]
    assert found.x.tolist() == [0.0, 1e-6]


def test_options_go_before_the_header(tmp_path):
    found = read_heights(written(tmp_path, MAP + ROWS), pixel=1.0, height_scale=2.0)
    assert found.x.tolist() == [0.0, 1.0, 2.0]
    assert found.heights[0].tolist() == [2.0, 4.0, 6.0]


def test_a_single_column_is_a_trace(tmp_path):
    path = written(tmp_path, "1\n2\n3\n")
    found = read_heights(path, pixel=0.5, length_unit="mm", height_unit="um")
    assert found.x.tolist() == [0.0, 5e-4, 1e-3]
    assert found.heights == pytest.approx(1e-6 * np.array([[1.0, 2.0, 3.0]]))


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("", {}, "numbers = 'nothing': needs columns of numbers"),
        ("words\nonly\n", {}, "numbers = 'nothing'"),
        ("1 2 3\n4 5\n", {"pixel": 1.0}, "line 2 = '2 numbers': needs 3 numbers"),
        ("1 2\n3 4\nend of file\n", {}, "line 3 = 'end of file': needs numbers"),
        ("x/m z/m\n1 2\n3 nan\n4 5\n", {}, "line 3, column 2 = 'missing, with 33%'"),
        ("1 2\n1 3\n", {}, "line 2, column 1 = 1: needs increasing"),
        ("1 2\n3 4\n", {"pixel": 1.0}, "pixel = 1: needs none"),
        (ROWS, {}, "line 1 = '3 columns': needs 2 .*, or pixel"),
        ("1 2 3 4\n", {}, "pixel = 'nothing': needs the distance of samples"),
        (ROWS, {"pixel": -1.0}, "pixel = -1: needs pixel > 0"),
        (MAP.replace("h=2", "h=5") + ROWS, {}, "h = 5: needs 2"),
        (MAP.replace("2e-006", "??") + ROWS, {}, r"pixel size = '\?\? m'"),
        ("pixel size=1 m\ndata unit=rad\n" + ROWS, {}, "line 2 = 'rad': .*height_scale"),
    ],
)
def test_unreadable_files_say_why(text, options, message, tmp_path):
    path = written(tmp_path, text)
    with pytest.raises(ValueError, match=message) as caught:
        read_heights(path, **options)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ValueError, match=r"none\.txt: No such file"):
        read_heights(tmp_path / "none.txt")


def grooves(rows=6, noise=0.0, drift=0.1, seed=1):
    """A map of asymmetric grooves of period 1e-5 that cross the rows at an angle."""
    x = np.linspace(0.0, 4.2e-5, 240)
    shift = drift * np.arange(rows)[:, None]
    phase = 2 * np.pi * (x / 1e-5 + shift)
    heights = 1e-5 * (0.02 * np.sin(phase) + 0.004 * np.sin(2 * phase))
    scatter = 1e-7 * noise * np.random.default_rng(seed).normal(size=heights.shape)
    return Measured(x, heights + scatter + 1e-3 * x)


def test_rows_are_moved_into_phase_before_their_mean():
    found = fit_profile(grooves(), harmonics=3)
    assert found.period == pytest.approx(1e-5, rel=1e-4)
    exact = fx.profiles.Fourier([0.0, 0.0], [0.02, 0.004])  # steep climbs, gentle falls
    ours, theirs = (fx.friction(p, BRISTLE) for p in (found.profile, exact))
    assert ours.rho_plus == pytest.approx(float(theirs.rho_plus), rel=1e-3)
    assert ours.rho_minus == pytest.approx(float(theirs.rho_minus), rel=1e-3)
    assert found.explained > 0.999


def test_a_map_in_python_is_read_as_from_a_file():
    measured = grooves()
    shell = fit_profile(measured, harmonics=3)
    found = fx.profiles.Fourier.from_heights(measured.x, measured.heights, harmonics=3)
    assert np.array_equal(found.profile.sin, shell.profile.sin)
    assert (found.period, found.explained) == (shell.period, shell.explained)
    plain = fx.profiles.Fourier.from_heights(measured.x, measured.heights.mean(0), 1e-5, 3)
    assert np.hypot(plain.profile.cos, plain.profile.sin)[0] < 0.018  # smeared out
    assert np.hypot(found.profile.cos, found.profile.sin)[0] > 0.0199


@pytest.mark.parametrize(
    ("x", "heights", "message"),
    [
        (np.arange(40.0), np.zeros((0, 40)), "heights"),
        (np.arange(40.0), np.full((3, 40), np.nan), "finite heights"),
        (np.arange(40.0), np.zeros((3, 40)), "heights that vary"),
        (np.arange(39.0), np.zeros((3, 40)), "the shape"),
        (-np.arange(40.0), np.zeros((3, 40)), "increasing positions"),
        (np.arange(40.0), np.zeros((2, 3, 40)), "heights"),
    ],
)
def test_wrong_maps_are_named(x, heights, message):
    with pytest.raises(ValueError, match=message):
        fx.profiles.Fourier.from_heights(x, heights)


def test_one_row():
    measured = grooves()
    one = fit_profile(measured, 1e-5, 2, row=2)
    alone = fit_profile(Measured(measured.x, measured.heights[2:3]), 1e-5, 2)
    assert np.array_equal(one.profile.cos, alone.profile.cos)
    with pytest.raises(ValueError, match="row = 6: needs 0 <= row <= 5"):
        fit_profile(measured, 1e-5, 2, row=6)


@pytest.mark.filterwarnings("ignore::frictionjax.profiles.SlopesUndetermined")
def test_coefficients_over_rows():
    measured = grooves(noise=0.3)
    found = row_coefficients(measured, BRISTLE, harmonics=2)
    assert found.used == list(range(6))
    law = fx.friction(fit_profile(measured, found.period, 2, row=3).profile, BRISTLE)
    assert found.values["rho_plus"][3] == pytest.approx(float(law.rho_plus), rel=1e-12)
    assert found.values["ratio"][3] == pytest.approx(float(-law.rho_plus / law.rho_minus))
    rho = found.values["rho_plus"]
    assert found.mean["rho_plus"] == pytest.approx(rho.mean())
    assert found.std["rho_plus"] == pytest.approx(rho.std(ddof=1))
    assert 0 < found.std["rho_plus"] < 0.3 * found.mean["rho_plus"]


@pytest.mark.filterwarnings("ignore::frictionjax.profiles.SlopesUndetermined")
def test_error_of_the_mean_profile_is_what_fresh_noise_shows():
    maps = [grooves(20, noise=0.3, seed=seed) for seed in range(30)]
    laws = [fx.friction(fit_profile(m, 1e-5, 2).profile, BRISTLE) for m in maps]
    scatter = np.std([float(law.rho_plus) for law in laws])
    found = [row_coefficients(m, BRISTLE, 2, 1e-5).error["rho_plus"] for m in maps[:4]]
    assert np.mean(found) == pytest.approx(scatter, rel=0.4)


def test_slopes_of_a_noisy_map_are_known_better_than_those_of_a_row():
    exact = slopes_of_waves(np.array([-0.02j, -0.004j]))
    measured = grooves(60, noise=0.02)
    found = fit_profile(measured, 1e-5, 3).slopes
    one = fit_profile(measured, 1e-5, 3, row=0).slopes
    for errors in (found, one):
        assert abs(errors.omega_plus - exact[0]) < errors.error_plus
        assert abs(errors.omega_minus - exact[1]) < errors.error_minus
    assert found.relative < 0.4 * one.relative < 0.04
    smooth = fit_profile(measured, 1e-5, 3, smoothing=1e-6)
    assert smooth.smoothing == 1e-6
    assert smooth.slopes.omega_plus < found.omega_plus


def test_rows_that_the_bristle_does_not_admit_are_listed():
    measured = grooves()
    steep = measured.heights * np.array([1, 1, 8, 1, 1, 1])[:, None]
    found = row_coefficients(Measured(measured.x, steep), BRISTLE, 2, 1e-5)
    assert found.used == [0, 1, 3, 4, 5]
    assert list(found.refused) == [2]
    assert "omega_plus < cot(angle)" in found.refused[2]
    assert found.values["rho_plus"].shape == (5,)
    with pytest.raises(
        ValueError, match=r"rows = 'none admissible'.*row 0: bristle\.angle"
    ):
        row_coefficients(Measured(measured.x, 8 * measured.heights), BRISTLE, 2, 1e-5)


needs_data = pytest.mark.skipif(not DATA.exists(), reason="measured surfaces are absent")


@needs_data
def test_the_grooved_surface():
    """About 25 pixels a groove, phase in rad: heights of some tenths of a micrometre."""
    found = read_heights(DATA / "grooved_surface_phase_map.txt")
    assert found.heights.shape == (305, 75)
    assert found.x[1] == pytest.approx(3.69862e-7)
    assert found.heights[0, 0] == pytest.approx(-4.448661 * 2.91818e-8)
    few = Measured(found.x, found.heights[::20])
    rows = row_coefficients(few, BRISTLE, harmonics=6)
    assert 8.5e-6 < rows.period < 10e-6
    assert rows.mean["explained"] > 0.7
    assert rows.mean["ratio"] > 1  # a bristle that leans: more friction to the right


@needs_data
def test_the_line_scan():
    with pytest.warns(MeasuredWarning, match="line 1, columns 1 and 2: no unit of lengths"):
        found = read_heights(DATA / "stylus_line_scan.txt")
    assert found.heights.shape == (1, 3001)
    assert found.x[-1] == pytest.approx(5e-5, rel=1e-3)
    assert np.ptp(found.heights) < 1e-7
