"""The command line: what it prints, what it writes, how it fails."""

import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import jax
import numpy as np
import pytest
import xarray as xr
from command_line import error_line, run
from html_pages import checked_page

import frictionjax as fx
from frictionjax._compile import program_cache
from frictionjax.cli import command_group
from frictionjax.cost.machine_cost import MachineCost
from frictionjax.io.scene_files import default_study, scene_document
from frictionjax.report import filled
from frictionjax.report.place import WRITTEN
from frictionjax.wiggly.equation.status import warn_of_failed

SMALL = ["--eps", "0.097:0.031:4", "--gamma", "1,2", "--no-progress"]


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study") / "made" / "here"
    return folder, run("study", *SMALL, "--out", folder)


def test_study_prints_its_tables(study):
    folder, result = study
    assert result.exit_code == 0, result.stderr
    for title in ("Friction coefficients", "Cells", "Orders of convergence"):
        assert title in result.stdout
    assert "no cell failed" in result.stdout
    assert result.stdout.endswith(f"Written to {folder}\n")
    assert result.stderr.startswith("Expected: ")
    assert len(result.stderr.splitlines()) == 1


def test_a_budget_is_told_before_anything_runs(tmp_path, monkeypatch):
    def stop(job, place, method, progress):
        raise ValueError("stopped before it ran")

    monkeypatch.setattr("frictionjax.report.run_study", stop)
    machine = MachineCost(0.02, 0.01, 1e-4, 1e-7, 1e-6, 10.0, 5e8)
    for name in ("machine_cost", "known_machine"):
        monkeypatch.setattr(f"frictionjax.cost.prediction.{name}", lambda *_: machine)
    result = run("study", *SMALL, "--budget", "1000", "--out", tmp_path / "there")
    first, last = result.stderr.splitlines()
    assert first.startswith("Budget of 1000 s: accuracy")
    assert last == "Error: stopped before it ran"


def test_failed_cells_are_one_warning_of_the_shell(tmp_path, monkeypatch):
    """A table names them too, which may have gone into a file."""

    def failed(*_, **__):
        for _ in range(2):  # of the sweep, and of its study
            warn_of_failed(np.array([[0, 1]]), np.array([1.0]), np.array([0.1, 0.05]))
        raise ValueError("stopped after it ran")

    monkeypatch.setattr("frictionjax.report.study.sweep", failed)
    lines = run("study", *SMALL, "--out", tmp_path / "there").stderr.splitlines()
    (said,) = [line for line in lines if line.startswith("Warning: ")]
    assert said.startswith(
        "Warning: 1 of 2 cells failed (gamma = 1, eps = 0.05: MAX_STEPS)"
    )
    assert lines[-1] == "Error: stopped after it ran"


def test_study_writes_a_folder(study):
    folder, result = study
    names = {path.name for path in folder.iterdir()}
    pictures = {"convergence.png", "trajectories.png", "loop.png", "dissipation.png"}
    assert names == pictures | {"study.nc", "orders.nc", "tables.txt", "scene.toml"}
    assert names <= WRITTEN
    for picture in pictures:
        assert (folder / picture).read_bytes().startswith(b"\x89PNG")
    assert (folder / "tables.txt").read_text() in result.stdout


def test_study_data_are_those_asked_for(study):
    folder, _ = study
    data = xr.load_dataset(folder / "study.nc", engine="h5netcdf")
    assert data.eps.values == pytest.approx(np.geomspace(0.097, 0.031, 4))
    assert data.gamma.values.tolist() == [1.0, 2.0]
    orders = xr.load_dataset(folder / "orders.nc", engine="h5netcdf")
    assert orders.order.values == pytest.approx(fx.study(data).orders.order.values)


def test_the_scene_written_gives_the_same_study(study):
    folder, _ = study
    again = fx.load_scene(folder / "scene.toml")
    data = xr.load_dataset(folder / "study.nc", engine="h5netcdf")
    assert data.z_limit.values == pytest.approx(fx.solve_limit(again, data.time.values).z)


@pytest.mark.slow  # loops of tips with mass: 16 s
def test_a_study_has_the_effects_of_its_scene(tmp_path):
    parts = fx.supports.Spring(1.0), fx.loads.Ramp(1.0), 0.5
    effects = (fx.effects.Inertia(1.0, 3.0),)
    bristle = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    scene = fx.Scene(fx.profiles.Sine(0.1), bristle, *parts, effects=effects)
    fx.save_scene(scene, tmp_path / "mine.toml")
    options = ["--eps", "0.05,0.04,0.03", "--gamma", "1", "--no-progress"]
    options += ["--report", "--out", tmp_path / "made"]
    result = run("study", tmp_path / "mine.toml", *options)
    assert result.exit_code == 0, result.stderr
    assert "Inertia\ngamma = 1: the mass does not fall faster" in result.stdout
    assert "as nobody has measured scenes with such effects" in result.stderr
    data = xr.load_dataset(tmp_path / "made" / "study.nc", engine="h5netcdf")
    assert np.all(data.beta > 0)
    page = checked_page((tmp_path / "made" / "report.html").read_text(encoding="utf-8"))
    assert "the mass does not fall faster" in page.text
    assert "Inertia mass 1 kg/m^exponent" in page.text
    assert fx.load_scene(tmp_path / "made" / "scene.toml").effects


def test_friction():
    result = run("friction")
    assert result.exit_code == 0
    assert "rho_plus" in result.stdout
    numbers = json.loads(run("friction", "--json").stdout)
    law = fx.friction(fx.profiles.Sine(0.1), fx.bristles.SlantedSpring(1, 2.4, 1, 1.0))
    assert numbers["rho_plus"] == pytest.approx(float(law.rho_plus), rel=1e-12)
    assert numbers["ratio"] == pytest.approx(float(-law.rho_plus / law.rho_minus))


def test_nap(tmp_path):
    assert "against/with = 0.73" in run("nap").stdout
    options = ("--bristle", "angular", "--bending-stiffness", "0.03")
    result = run("nap", *options, "--json")
    numbers = json.loads(result.stdout)
    rod = fx.bristles.AngularSpring(1.0, 1.414, 1.0, 0.3)
    found = fx.nap(fx.profiles.Sine(0.1), rod, 0.03)
    assert numbers["rho_against"] == pytest.approx(found.rho_against, rel=1e-3)
    assert numbers["window"] is None
    assert "nap.png" in run("nap", *options, "--out", tmp_path).stdout
    assert (tmp_path / "nap.png").stat().st_size > 10_000


def test_nap_of_a_bristle_without_its_picture_is_its_table_and_a_line(tmp_path):
    """It was refused, without a word of `--out` or of the bristle that has one."""
    plain = run("nap", "--out", tmp_path / "none")
    assert plain.exit_code == 0
    line = "No nap.png: that is of rods on an angular spring (--bristle angular), not "
    assert f"{line}SlantedSpring\n" in plain.stdout
    assert "against/with = 0.73" in plain.stdout
    assert not (tmp_path / "none").exists()
    numbers = run("nap", "--json", "--out", tmp_path / "none")
    assert json.loads(numbers.stdout)["window"] is None
    assert line in numbers.stderr
    reported = run("nap", "--report", "--out", tmp_path / "made")
    assert f"report.html\n{line}" in reported.stdout
    assert not (tmp_path / "made" / "nap.png").exists()


def test_nap_says_what_of_a_scene_it_leaves_out(tmp_path):
    run("scenes", "rigid-array", "--out", tmp_path / "mine.toml")
    note = "of one bristle, in the limit: without the scene's RigidArray"
    assert note in run("nap", tmp_path / "mine.toml").stdout
    assert (
        note in json.loads(run("nap", tmp_path / "mine.toml", "--json").stdout)["notes"][0]
    )
    assert "without the scene" not in run("nap").stdout


def test_what_a_command_does_not_do_is_named_with_its_file(tmp_path):
    file = tmp_path / "mine.toml"
    run("scenes", "noise", "--out", file)
    told = run("cost", file, "--out", tmp_path / "cost")
    assert told.exit_code == 2
    named = f"Error: {file}: [[effects]] a measure of cost (work_precision, "
    assert told.stderr.startswith(named)
    assert "does not do Noise: needs explain" in told.stderr
    assert told.stderr.count("\n") == 1


def test_a_command_of_a_test_leaves_nothing_in_the_users_folder():
    assert run("scenes", "noise").exit_code == 0
    assert program_cache._place is None
    folder = Path(jax.config.jax_compilation_cache_dir)
    assert folder == Path(os.environ["JAX_COMPILATION_CACHE_DIR"])


def test_a_study_of_a_scene_with_noise_has_a_seed(tmp_path, monkeypatch):
    """Its page says how to do it again: with the same path."""
    usual, file, few = tmp_path / "usual", tmp_path / "mine.toml", ["--eps", "0.1,0.05"]
    other, again = tmp_path / "other", tmp_path / "again"
    run("scenes", "noise", "--out", file)
    run("study", file, *few, "--seed", 7, "--report", "--out", other)
    # Pictures once: the tables of the others are read.
    monkeypatch.setattr("frictionjax.report.folder.write_figures", lambda *_: [])
    assert run("study", file, *few, "--out", usual).exit_code == 0
    run("study", other / "scene.toml", "--seed", 7, "--out", again)
    told = [(one / "tables.txt").read_text() for one in (usual, other, again)]
    assert told[0] != told[1] == told[2]
    page = re.sub("<[^>]*>", "", (other / "report.html").read_text())
    assert "frictionjax study scene.toml --seed 7 --out again --report" in page
    refused = run("study", *few, "--seed", 3, "--out", tmp_path / "plain")
    needs = "Error: seed = 3: needs none: the scene has no effects.Noise\n"
    assert error_line(refused) == needs


def test_nap_of_a_rod_that_turns_over(tmp_path):
    run("scenes", "nap-flip", "--out", tmp_path / "mine.toml")
    told = run("nap", tmp_path / "mine.toml", "--out", tmp_path).stdout
    assert "turns over, and friction is rho_with and rho_flipped" in told
    for name in ("nap.png", "turning.png", "nap_loops.png"):
        assert name in told
        assert (tmp_path / name).stat().st_size > 10_000


def test_a_scene_that_was_worked_on_is_not_written_over(tmp_path):
    file = tmp_path / "mine.toml"
    file.touch()
    for name in ("nap", "noise", "noise"):  # over nothing, over another, over itself
        assert run("scenes", name, "--out", file).exit_code == 0
    mine = file.read_text() + "# mine\n"
    file.write_text(mine)
    line = error_line(run("scenes", "noise", "--out", file))
    assert "out = " in line
    assert "needs a new name: a file is there, and it is no scene that ships" in line
    assert file.read_text() == mine


@pytest.mark.parametrize(
    ("command", "said"),
    [
        (("scenes", "--out", "x.toml"), "--out: needs NAME beside it"),
        (("scenes", "--schema", "--out", "x.toml"), "--out: not with --schema"),
        (("scenes", "nap", "--out", ""), "out = '': needs the name of a file"),
        (("study", "--out", ""), "out = '': needs the name of a folder"),
        (("figures", "--out", ""), "out = '': needs the name of a folder"),
    ],
)
def test_a_place_for_nothing_and_a_place_without_a_name_are_refused(
    command, said, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    assert said in error_line(run(*command))
    assert not list(tmp_path.iterdir())


def test_help_of_costs_says_which_of_its_options_writes_nothing():
    (line,) = [
        line for line in run("cost", "--help").stdout.splitlines() if "--out DIR" in line
    ]
    assert "Not with --order-within" in line


def test_scenes(tmp_path):
    assert "nap-flip " in run("scenes").stdout
    text = run("scenes", "noise").stdout
    assert 'kind = "Noise"' in text
    assert "Written to" in run("scenes", "noise", "--out", tmp_path / "mine.toml").stdout
    assert (tmp_path / "mine.toml").read_text() == text
    assert "bending_stiffness" in run("scenes", "--schema").stdout
    assert "needs one of angular-spring" in run("scenes", "noises").stderr


def test_friction_of_a_scene_file(tmp_path):
    parts = fx.supports.Spring(1.0), fx.loads.Ramp(1.0), 1.0
    scene = fx.Scene(fx.profiles.Sine(0.2), fx.bristles.Homothetic(3.0), *parts)
    fx.save_scene(scene, tmp_path / "mine.toml")
    numbers = json.loads(run("friction", tmp_path / "mine.toml", "--json").stdout)
    assert numbers["rho_plus"] == pytest.approx(0.6)
    angular = run("friction", tmp_path / "mine.toml", "--json", "--bristle", "angular")
    assert json.loads(angular.stdout)["a"] == pytest.approx(1.0)


def grooves(folder):
    """A map of grooves that lean: two harmonics, three rows, period 9e-6 m."""
    phase = 2 * np.pi * np.arange(120) * 3e-7 / 9e-6
    rows = [a * np.sin(phase) + 0.2 * np.sin(2 * phase) for a in (0.9, 1.0, 1.1)]
    text = "\n".join(" ".join(f"{v:.9g}" for v in row) for row in rows)
    path = folder / "map.txt"
    path.write_text(f"pixel size=3e-7 m\nheight conversion factor (-> m)=1e-7\n{text}\n")
    return path


def test_friction_of_a_measured_map(tmp_path):
    options = ["--heights", grooves(tmp_path), "--harmonics", "2"]
    result = run("friction", *options)
    assert result.exit_code == 0, result.stderr
    assert "period 9e-06 m, the surface's real eps, explains" in result.stdout
    assert "3 rows, period" in result.stdout
    numbers = json.loads(run("friction", *options, "--json").stdout)
    assert numbers["rows"]["std"]["rho_plus"] > 0
    one = json.loads(run("friction", *options, "--json", "--row", "2").stdout)
    assert one["rho_plus"] > numbers["rho_plus"]
    longer = ["--pixel", "6e-7", "--height-scale", "2e-7", "--json"]
    scaled = json.loads(run("friction", *options, *longer).stdout)
    assert scaled["rho_plus"] == pytest.approx(numbers["rho_plus"], rel=1e-6)


@pytest.mark.slow
def test_study_of_a_measured_map(tmp_path):
    folder = tmp_path / "out"
    options = ["--heights", grooves(tmp_path), "--harmonics", "2", "--out", folder]
    result = run("study", *SMALL, "--gamma", "1", *options)
    assert result.exit_code == 0, result.stderr
    assert "Friction over the rows of the map" in result.stdout
    profile = fx.load_scene(folder / "scene.toml").profile
    assert isinstance(profile, fx.profiles.Fourier)


def test_study_of_every_row_of_a_map(tmp_path):
    folder = tmp_path / "out"
    options = ["--heights", grooves(tmp_path), "--harmonics", "2", "--rows"]
    result = run("study", *SMALL, *options, "--report", "--out", folder)
    assert result.exit_code == 0, result.stderr
    assert result.stderr.startswith("Expected: 3 rows, each about ")
    assert "; then 0.6 to 1.5 s for laws and orders" in result.stderr
    assert "Orders over the rows of the map" in result.stdout
    with xr.open_dataset(folder / "study.nc", engine="h5netcdf") as data:
        assert data.scene.values.tolist() == [0, 1, 2]
        assert int(data.status.max()) == fx.Status.OK
    with xr.open_dataset(folder / "orders.nc", engine="h5netcdf") as orders:
        assert orders.order.sizes == {"scene": 3, "gamma": 2}
    assert {"spread.nc", "convergence.png"} <= {path.name for path in folder.iterdir()}
    page = checked_page((folder / "report.html").read_text(encoding="utf-8"))
    assert "Over 3 rows of the map the motion comes" in page.text
    assert "The energy balance of the worst that did not fail closes to" in page.text
    assert "study scene.toml" not in page.text  # which holds their mean


OLD = ("report.html", "dissipation.png", "nap.png", "notes of mine.txt")


@pytest.fixture(scope="module")
def figures(tmp_path_factory):
    """A folder in which something was before, and what the command said."""
    folder = tmp_path_factory.mktemp("figures")
    for name in OLD:
        (folder / name).write_text("old")
    return folder, run("figures", "--out", folder)


def test_figures(figures):
    folder, result = figures
    assert result.exit_code == 0, result.stderr
    pictures = {"mu_slanted.png", "mu_angular.png", "nap.png"}
    assert {path.name for path in folder.iterdir()} == pictures.union(OLD)
    for name in pictures:
        assert (folder / name).read_bytes().startswith(b"\x89PNG")
    assert pictures <= WRITTEN


def test_what_an_earlier_run_has_left_is_named(figures):
    """A report or a picture of another bristle would be taken for this run's."""
    folder, result = figures
    said = f"Written to {folder}\nNot of this run, there before: "
    assert result.stdout.endswith(f"{said}dissipation.png, report.html\n")
    assert (folder / "report.html").read_text() == "old"


def test_help_without_a_command():
    result = run()
    assert result.exit_code == 0
    for command in ("study", "friction", "figures"):
        assert command in result.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nope"], "No such command 'nope'"),
        (["study", "--nope"], "No such option '--nope'"),
        (["study", "--eps", "0.1,x"], "eps = '0.1,x': needs numbers > 0"),
        (["study", "--gamma", "0"], "gamma = '0': needs numbers > 0"),
        (["study", "--accuracy", "0"], "accuracy = 0: needs"),
        (["study", "--accuracy", "high"], "'high' is not a valid float"),
        (["study", "--method", "magic"], "method = 'magic': needs one of auto"),
        (["study", "none.toml"], "none.toml: cannot be read (No such file"),
        (["study", "--heights", "none.txt"], "none.txt: No such file"),
        (["study", "--row", "1"], "row = 1: needs --heights FILE"),
        (["study", "--rows"], "--rows: needs --heights FILE with a map, and no --row"),
        (["study", "--rows", "--budget", "9"], "--budget: not with --rows"),
        (["friction", "--bristle", "soft"], "'soft' is not one of 'slanted', 'angular'"),
        (["cost", "--order-within", "0.1", "--methods", "auto"], "not with --order-within"),
        (["cost", "--order-within", "0.1", "--report"], "--report: not with"),
        (
            ["cost", "--order-within", "0.1", "--out", "x", "--seconds", "7"],
            "--seconds, --out: not with --order-within",
        ),
        (["cost", "--order-within", "0.1", "--progress"], ": --progress: not with"),
        (["cost", "--order-within", "0.1", "--no-progress"], "--no-progress: not with"),
        (
            ["nap", "--bending-stiffness", "0.1"],
            "--bending-stiffness = 0.1: needs a rod on an angular spring (--bristle a",
        ),
        (["cost", "--order-within", "0.1", "--eps", ""], "eps = '': needs numbers > 0"),
        (["cost", "--eps", ""], "eps = '': needs numbers > 0"),
        (["cost", "--gamma", ""], "gamma = '': needs numbers > 0"),
        (["cost", "--accuracies", ""], "accuracies = '': needs numbers > 0"),
        (["cost", "--methods", ""], "methods = '': needs one of"),
        (["study", "--budget", "5", "--accuracy", "0"], "accuracy = 0: needs"),
        (["friction", "a", "b"], "unexpected extra argument (b)"),
    ],
)
def test_bad_arguments_are_one_line_and_write_nothing(
    arguments, message, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    assert message in error_line(run(*arguments))
    assert not list(tmp_path.iterdir())


def test_a_start_outside_the_strip_is_one_line(tmp_path):
    text = scene_document(*default_study()).replace("z0 = 0.0", "z0 = 5.0")
    (tmp_path / "mine.toml").write_text(text)
    out = tmp_path / "out"
    line = error_line(run("study", tmp_path / "mine.toml", "--out", out, *SMALL))
    assert "scene.z0 = 5: needs z_minus(0) <= z0 <= z_plus(0)" in line
    assert not out.exists()


def test_a_file_in_the_way_is_named_before_anything_runs(tmp_path):
    (tmp_path / "out").touch()
    line = error_line(run("study", "--out", tmp_path / "out"))
    assert "needs a folder" in line


def test_descriptions_of_commands_are_whole():
    """At 80 columns, where five of eight were cut."""
    text = run("--help", terminal_width=80)
    listed = text.stdout.partition("Commands:\n")[2].splitlines()
    assert len(listed) == 8
    assert all(line.endswith(".") and not line.endswith("...") for line in listed)


def test_units_that_a_trace_lacks_are_named_as_options(tmp_path):
    file = tmp_path / "length_unit.txt"
    x = np.linspace(0.0, 50.0, 200)
    np.savetxt(file, np.stack([x, 10 * np.sin(x)], axis=1))
    line = error_line(run("friction", "--heights", file))
    assert "needs --length-unit and --height-unit (or --height-scale): the file" in line
    assert f"{file}: " in line
    line = error_line(run("friction", "--heights", file, "--length-unit", "um"))
    assert "needs --height-unit or --height-scale, beside --length-unit" in line


def test_an_angle_in_degrees_is_told_in_rad(tmp_path):
    text = scene_document(*default_study())
    (tmp_path / "mine.toml").write_text(text.replace("angle = 1.0", "angle = 60.0"))
    line = error_line(run("friction", tmp_path / "mine.toml"))
    assert "needs -pi/2 < angle < pi/2 in rad (60 degrees are 1.047 rad)" in line


def test_help_waits_for_no_library():
    code = (
        "import sys, frictionjax.cli\n"
        "heavy = {'jax', 'matplotlib', 'xarray', 'numpy'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_package_runs_as_a_module():
    command = [sys.executable, "-m", "frictionjax", "study", "--eps", "none"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("Error: ")
    assert "eps = 'none'" in done.stderr


@pytest.mark.slow  # compiles in a process of its own: 16 s
@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_is_quiet(tmp_path, number):
    """Sent when the bar shows that the sweep is under way, in compiled code."""
    # A shell that runs the tests in the background has them ignore SIGINT; undone here.
    code = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "from frictionjax.cli import main; main()"
    )
    command = [sys.executable, "-c", code, "study"]
    # Every slip of small eps: nothing can be done before the signal is there.
    options = ["--eps", "1e-6", "--method", "resolved", "--out", str(tmp_path / "out")]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command + options, **pipes) as process:
        seen = b""
        while b"cells" not in seen:
            letter = process.stderr.read(1)
            assert letter, seen  # ended before it began
            seen += letter
        process.send_signal(number)
        out, err = process.communicate(timeout=120)
    assert process.returncode == 128 + number
    assert out == b""
    assert b"Traceback" not in err
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_sigterm_is_heard_while_a_command_runs(tmp_path):
    def work():
        with command_group._heard(), filled(tmp_path / "out") as place:
            (place / "one").write_text("half")
            signal.raise_signal(signal.SIGTERM)

    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(command_group.Left) as left:
        work()
    assert left.value.status == 143
    assert not list(tmp_path.iterdir())
    assert signal.getsignal(signal.SIGTERM) == before


@pytest.mark.slow
def test_cost_measures_methods(tmp_path):
    folder = tmp_path / "cost"
    small = ["--eps", "0.09", "--accuracies", "1e-2", "--methods", "auto,LSODA"]
    result = run("cost", *small, "--no-progress", "--out", folder)
    assert result.exit_code == 0, result.stderr
    assert "eps = 0.09 m" in result.stdout
    names = {path.name for path in folder.iterdir()}
    assert names == {"cost.nc", "tables.txt", "scene.toml", "work_precision.png"}
    assert names <= WRITTEN
    with xr.open_dataset(folder / "cost.nc", engine="h5netcdf") as data:
        assert list(data.solver.values) == ["auto", "LSODA"]
        assert float(data.error.sel(solver="auto").squeeze()) < 1e-2


@pytest.mark.parametrize(
    ("options", "most"),
    [
        ([], 25.0),
        (["--total", "9"], 9.0),
        (["--methods", "auto"], None),
        (["--methods", "auto", "--total", "9"], 9.0),
    ],
)
def test_cost_bounds_its_time_where_no_methods_are_named(
    tmp_path, monkeypatch, options, most
):
    asked = {}

    def measured(job, place, methods, accuracies, seconds, progress, total):
        asked.update(eps=job.study["eps"], total=total)
        return ""

    monkeypatch.setattr("frictionjax.report.run_cost", measured)
    assert run("cost", *options, "--out", tmp_path / "cost").exit_code == 0
    assert len(asked["eps"]) == 2
    # What loading took is no longer there.
    assert asked["total"] is None if most is None else 0 < asked["total"] < most


def test_cost_refuses_unknown_methods(tmp_path):
    result = run("cost", "--methods", "magic", "--out", tmp_path)
    assert "methods = 'magic'" in error_line(result)
