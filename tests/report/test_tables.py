"""Tables: every number in its column, nothing dropped."""

import errno
import tempfile

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.coefficients import coefficients_by_name, errors_by_name
from frictionjax.measured import RowCoefficients
from frictionjax.report.job import number_list, read_job
from frictionjax.report.place import filled, require_folder
from frictionjax.report.tables import row_table

LAW = fx.friction(fx.profiles.Sine(0.1), fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0))


def test_rows_of_a_map():
    names = [name for name in coefficients_by_name(LAW) if name not in ("alpha", "a")]
    values = {name: np.array([1.0, 3.0]) for name in (*names, "explained")}
    text = row_table(RowCoefficients(values, 9e-6, [0, 2], {1: "too steep"}, {}))
    assert text.startswith("2 rows, period 9e-06 m")
    assert text.splitlines()[2].split()[:4] == ["rho_plus", "2", "1.4", "N"]
    assert text.splitlines()[-2:] == [
        "1 rows left out, not admissible for the bristle:",
        "  row 1: too steep",
    ]


def test_the_rows_of_a_map_are_the_same_whichever_is_chosen(tmp_path):
    """With the period of all of them, and the friction above is not that of the mean."""
    rng, x = np.random.default_rng(0), np.arange(60) * 5e-7
    heights = 1e-7 * np.array([np.sin(2 * np.pi * x / 1e-5 + t) for t in range(6)])
    np.savetxt(tmp_path / "map.txt", heights + 2e-8 * rng.standard_normal(heights.shape))
    known = {"pixel": 5e-7, "height_unit": "m", "harmonics": 2}
    mean, one = (
        read_job(None, heights=str(tmp_path / "map.txt"), row=row, **known)
        for row in (None, 3)
    )
    assert one.rows.period == mean.rows.period
    np.testing.assert_array_equal(one.rows.values["ratio"], mean.rows.values["ratio"])
    assert "of the mean profile, which is the one above" in row_table(mean.rows, mean.row)
    assert "the friction above is that of\nrow 3 alone" in row_table(one.rows, one.row)
    assert "mean profile" not in row_table(one.rows, one.row)


def test_number_lists():
    assert number_list("eps", "0.1,0.05") == [0.1, 0.05]
    assert number_list("eps", "0.1:0.001:3") == pytest.approx([0.1, 0.01, 0.001])
    assert number_list("eps", "0.1") == [0.1]


@pytest.mark.parametrize(
    "text",
    ["", "a", "0.1,", "0.1:0.2", "0.1:0.2:0", "0:1:3", "-1", "inf", "1:2:2.5", "0.1 0.2"],
)
def test_bad_number_lists(text):
    with pytest.raises(ValueError, match=r"eps = .*: needs numbers > 0, as 0\.1,0\.05"):
        number_list("eps", text)


def test_a_folder_is_checked_but_not_made(tmp_path):
    assert require_folder(tmp_path / "a" / "b") == tmp_path / "a" / "b"
    assert not (tmp_path / "a").exists()
    (tmp_path / "file").touch()
    for path in (tmp_path / "file", tmp_path / "file" / "b"):
        with pytest.raises(ValueError, match=r"needs a folder, but .*file is a file"):
            require_folder(path)


def test_a_folder_is_filled_whole(tmp_path):
    folder = tmp_path / "deep" / "out"
    with filled(folder) as place:
        (place / "one").write_text("old")
        assert not folder.exists()
    with filled(folder) as place:
        (place / "one").write_text("new")
    assert [path.name for path in tmp_path.iterdir()] == ["deep"]
    assert [path.name for path in folder.iterdir()] == ["one"]
    assert (folder / "one").read_text() == "new"


def test_a_folder_where_nothing_can_be_made_is_named(tmp_path, monkeypatch):
    """As in /proc, which says that all may write there."""

    def refused(**_):
        raise FileNotFoundError(errno.ENOENT, "No such file", "/proc/.frictionjax-abc")

    monkeypatch.setattr(tempfile, "mkdtemp", refused)
    with pytest.raises(ValueError, match=r"out = '.*/out': needs leave to write in "):
        filled(tmp_path / "out").__enter__()


def test_an_interrupted_folder_is_left_alone(tmp_path):
    folder = tmp_path / "out"

    def work():
        with filled(folder) as place:
            (place / "one").write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        work()
    assert not list(tmp_path.iterdir())


def test_a_sawtooth_in_a_file_is_told_what_its_samples_leave_open(tmp_path):
    x = np.arange(320) * 1e-5 / 64
    heights = 1e-5 * np.interp(x * 1e5 % 1, [0.0, 0.8, 1.0], [0.0, 0.05, 0.0])
    np.savetxt(tmp_path / "saw.txt", np.stack([x, heights], axis=1))
    fit = {"heights": tmp_path / "saw.txt", "period": 1e-5, "harmonics": 3, "row": None}
    job = read_job(None, **fit)
    (note,) = [line for line in job.notes if "steepest slopes open" in line]
    assert note.startswith("Note: the samples leave")
    assert note.endswith("--smoothing LENGTH beside --heights")  # no call of Python
    assert "profiles." not in note
    errors = errors_by_name(fx.friction(job.scene))
    assert errors["omega_plus"] > 0.02
    assert set(errors) == set(coefficients_by_name(LAW)) - {"alpha", "a"}
    longer = read_job(None, **fit, smoothing=5e-6)
    assert any("cut-off 5e-06 m" in line for line in longer.notes)
    assert any("a shorter smoothing takes off less" in line for line in longer.notes)
    smooth = read_job(None, **fit | {"harmonics": 16}, smoothing=1e-6)
    assert not any("steepest slopes open" in line for line in smooth.notes)
    with pytest.raises(ValueError, match="smoothing = 1e-06: needs --heights FILE"):
        read_job(None, period=None, harmonics=None, row=None, smoothing=1e-6)


def test_a_named_bristle_takes_the_place_of_the_scenes():
    fit = {"period": None, "harmonics": None, "row": None}
    job = read_job(None, bristle="angular", **fit)
    assert isinstance(job.scene.bristle, fx.bristles.AngularSpring)
    assert isinstance(job.scene.profile, fx.profiles.Sine)
    with pytest.raises(ValueError, match="row = 2: needs --heights FILE"):
        read_job(None, **(fit | {"row": 2}))
