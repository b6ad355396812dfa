"""A full disk, a platform that is not there, a fork, a debug flag: one clear line each."""

import errno
import os
import signal
import subprocess
import sys
import traceback
import warnings
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import xarray as xr
from command_line import run
from sweep_like import sweep_like

import frictionjax as fx
from frictionjax._checks import naming, surroundings
from frictionjax._checks.surroundings import SurroundingsError, with_nan
from frictionjax._compile import program_cache as kept_programs
from frictionjax._compile.programs import Program
from frictionjax.report import folder as report_folder
from frictionjax.report.place import filled

SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.Homothetic(1.0),
    fx.supports.Spring(1.0),
    fx.loads.Ramp(1.0),
    1.0,
)


# Platforms.


@pytest.fixture
def not_started(monkeypatch):
    """As before JAX has started."""
    monkeypatch.setattr(surroundings, "_known", {"ready": False, "forked": False})


@pytest.mark.parametrize(
    "problem",
    [
        AssertionError(),
        RuntimeError("Unable to initialize backend 'x': it is not there. (set JAX_PLATF"),
    ],
)
@pytest.mark.parametrize(
    "call",
    [
        lambda: fx.profiles.Sine(0.1),
        lambda: fx.friction(SCENE),
        lambda: fx.solve(SCENE, 0.1),
        lambda: fx.sweep(SCENE, 0.1, 1.0),
    ],
)
def test_a_platform_that_is_not_there_is_named(call, problem, not_started, monkeypatch):
    def devices():
        raise problem

    monkeypatch.setattr(jax, "devices", devices)
    with pytest.raises(
        SurroundingsError, match=r"jax_platforms = .*set it to \"cpu\""
    ) as e:
        call()
    assert "\n" not in str(e.value)


def test_the_shell_says_so_in_one_line(not_started, monkeypatch):
    def devices():
        raise AssertionError

    monkeypatch.setattr(jax, "devices", devices)
    result = run("friction")
    assert result.exit_code == 2
    assert result.stderr.startswith("Error: jax_platforms = ")
    assert result.stderr.count("\n") == 1


@pytest.mark.slow
@pytest.mark.parametrize("platform", ["cuda", "rocm", "no such"])
def test_platforms_in_the_environment(platform):
    env = os.environ | {"JAX_PLATFORMS": platform}
    command = [sys.executable, "-m", "frictionjax", "friction"]
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.splitlines()[-1].startswith(f"Error: jax_platforms = '{platform}'")
    assert "Traceback" not in done.stderr


# Forks.


def forked(work):
    """What a forked process says; it would hang where it is not refused."""
    read, write = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of JAX, and of Python 3.12
        child = os.fork()
    if child == 0:
        try:
            signal.alarm(60)
            work()
            said = "done"
        except BaseException:
            said = traceback.format_exc(limit=0)
        os.write(write, said.encode())
        os._exit(0)
    os.close(write)
    os.waitpid(child, 0)
    with os.fdopen(read) as pipe:
        return pipe.read()


needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="nothing forks here")


@needs_fork
@pytest.mark.parametrize(
    "work",
    [
        lambda: fx.solve_limit(SCENE),
        lambda: fx.solve(SCENE, 0.1),
        lambda: fx.friction(SCENE),
        lambda: fx.loads.Ramp(2.0),
        lambda: fx.potential(SCENE.profile, SCENE.bristle).energy(0.0, 0.1),
        lambda: fx.fit_angle(SCENE.profile, SCENE.bristle, ratio=2.0),
    ],
)
def test_a_process_forked_after_jax_has_computed_is_told_what_to_do(work):
    jnp.zeros(1).block_until_ready()
    said = forked(work)
    assert "SurroundingsError: fork: JAX had computed" in said
    assert '"spawn" or "forkserver"' in said


@needs_fork
def test_what_needs_no_jax_runs_in_a_forked_process():
    data = sweep_like(failed=False)
    assert forked(lambda: fx.study(data)) == "done"


@needs_fork
@pytest.mark.slow
def test_a_process_forked_before_jax_has_computed_computes():
    code = """
import os, sys
import jax
jax.config.update("jax_enable_x64", True)
import frictionjax as fx
from frictionjax import friction
child = os.fork()
if child == 0:
    friction(fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0))
    os._exit(7)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.strip() == "7", done.stderr


# NaN as a value.


def test_programs_may_hold_nan_where_jax_looks_for_it():
    def none_below(x):
        return jnp.where(x > 0, x, jnp.nan)

    with jax.debug_nans(True):
        with pytest.raises(FloatingPointError):
            jax.jit(none_below)(np.array([-1.0]))
        assert np.isnan(Program(none_below)(np.array([-1.0])))
        assert np.isnan(with_nan(none_below)(jnp.array([-1.0])))
        assert jax.config.jax_debug_nans
    with jax.debug_infs(True):
        assert np.isinf(with_nan(lambda: jnp.ones(()) / 0.0)())


def test_entry_points_run_where_jax_looks_for_nan():
    with jax.debug_nans(True), jax.debug_infs(True):
        assert fx.solve_limit(SCENE).ok
        assert float(fx.friction(SCENE).rho_plus) == pytest.approx(0.1)
        assert SCENE.replace(duration=2.0).turns == 0


@pytest.mark.slow
def test_cells_run_where_jax_looks_for_nan():
    jax.config.update("jax_debug_nans", True)  # in all threads
    try:
        assert fx.solve(SCENE, 0.1).ok
        assert not fx.sweep(SCENE, [0.1, 0.05], [1.0]).status.any()
        assert not fx.sweep(SCENE, [0.1], [1.0], method="Kvaerno5").status.any()
        bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
        assert fx.fit_angle(SCENE.profile, bristle, ratio=1.1).success
    finally:
        jax.config.update("jax_debug_nans", False)


# Disks.

FULL = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EDQUOT, errno.EFBIG])
def test_a_full_disk_names_the_folder_and_leaves_nothing(code, tmp_path):
    with (
        pytest.raises(OSError, match="nothing was written") as found,
        filled(tmp_path / "a"),
    ):
        raise OSError(code, os.strerror(code))
    assert found.value.errno == code
    assert found.value.filename == str(tmp_path / "a")
    assert not list(tmp_path.iterdir())


def test_other_failures_stay_what_they_are(tmp_path):
    problem = OSError(errno.EIO, "broken")
    with pytest.raises(OSError, match="broken") as found, filled(tmp_path / "a"):
        raise problem
    assert found.value is problem


def test_a_full_disk_is_one_line_of_the_shell(tmp_path, monkeypatch):
    def full(*_):
        raise FULL

    monkeypatch.setattr("frictionjax.report.write_figures", full)
    result = run("figures", "--out", tmp_path / "out")
    assert result.exit_code == 1
    assert result.stderr == (
        f"Error: {tmp_path / 'out'}: {FULL.strerror}, nothing was written\n"
    )
    assert not list(tmp_path.iterdir())


def test_what_does_not_fit_is_named_where_it_was_going_to_be(tmp_path):
    with (
        pytest.raises(OSError, match="nothing was written") as found,
        filled(tmp_path / "a") as place,
        naming(place / "tables.txt"),
    ):
        raise OSError(errno.EFBIG, "File too large")
    assert found.value.filename == str(tmp_path / "a" / "tables.txt")
    assert not list(tmp_path.iterdir())


needs_full = pytest.mark.skipif(
    not Path("/dev/full").exists(), reason="no device that is full"
)


@pytest.mark.slow
@needs_full
@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["friction", "--json"]])
def test_what_is_printed_on_a_full_disk_is_one_line(arguments):
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "frictionjax", *arguments]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 1
    assert done.stderr == f"Error: standard output: {FULL.strerror}\n"


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGXFSZ"), reason="no limits of files here")
def test_a_limit_of_file_sizes_names_the_file(tmp_path):
    """A picture does not fit into 4 KB."""
    limited = ["sh", "-c", 'ulimit -f 8; exec "$0" "$@"', sys.executable, "-m"]
    command = [*limited, "frictionjax", "figures", "--out", str(tmp_path / "out")]
    kept = tmp_path / "kept"  # programs that do not fit either are not for other tests
    env = os.environ | {"JAX_COMPILATION_CACHE_DIR": str(kept)}
    done = subprocess.run(command, capture_output=True, text=True, env=env)
    assert done.returncode == 1
    path = tmp_path / "out" / "mu_slanted.png"
    last = done.stderr.splitlines()[-1]
    assert last == f"Error: {path}: File too large, nothing was written"
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()


@needs_full
@pytest.mark.parametrize("name", ["study.nc", "tables.txt", "scene.toml"])
def test_every_file_of_a_record_may_meet_a_full_disk(name, tmp_path):
    (tmp_path / name).symlink_to("/dev/full")
    data = {"study": sweep_like()}
    with pytest.raises(OSError, match=FULL.strerror) as found:
        report_folder.write_record(tmp_path, data, "z0 = 0.0", "text")
    assert found.value.errno == errno.ENOSPC


def test_no_data_set_is_written_by_hdf5(tmp_path, monkeypatch):
    """On a disk that is full half way it ended the process by a segmentation fault."""
    to_netcdf, places = xr.Dataset.to_netcdf, []

    def recorded(data, path, **options):
        places.append(path)
        return to_netcdf(data, path, **options)

    monkeypatch.setattr(xr.Dataset, "to_netcdf", recorded)
    report_folder.write_record(tmp_path, {"study": sweep_like()}, "", "")
    assert places == [None]
    again = xr.load_dataset(tmp_path / "study.nc", engine="h5netcdf")
    assert again.identical(sweep_like())


def write_three(folder):
    for shape in range(3):
        kept_programs._try_to_write(folder / f"{shape}.bin", b"")


def test_programs_that_cannot_be_kept_are_one_warning(tmp_path, monkeypatch):
    tried = []

    def full(path, data):
        tried.append(path)
        raise FULL

    monkeypatch.setattr(kept_programs, "_place", None)
    monkeypatch.setattr(kept_programs, "_writes", True)
    name = "jax_persistent_cache_min_compile_time_secs"
    before = jax.config._read(name)
    try:
        kept_programs.keep_in(tmp_path)
        monkeypatch.setattr(kept_programs, "_write", full)
        with pytest.warns(UserWarning, match=r"not kept in .* \(No space left") as told:
            write_three(tmp_path)
        assert len(told) == len(tried) == 1
        with pytest.warns(UserWarning, match="not kept"):
            kept_programs.keep_in(tmp_path / "other")  # tries anew
    finally:
        jax.config.update(name, before)
    assert not list(tmp_path.rglob("*.*"))


def test_half_a_file_is_not_left_behind(tmp_path, monkeypatch):
    def full(*_):
        raise FULL

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(OSError, match=FULL.strerror):
        kept_programs._write(tmp_path / "kept" / "a.bin", b"data")
    assert not list((tmp_path / "kept").iterdir())
