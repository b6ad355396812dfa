"""Settings of XLA that are made before JAX has computed anything."""

import importlib.metadata
import os
import subprocess
import sys
from pathlib import Path

import pytest

import frictionjax as fx
from frictionjax._compile import flags

PROGRAM = """
import jax, sys
import frictionjax as fx
if "early" in sys.argv:
    jax.numpy.ones(2).block_until_ready()
used = fx.use_fast_cpu(), fx.use_fast_cpu()
print(*used, jax.config._read("jax_cpu_enable_async_dispatch"))
"""


@pytest.mark.parametrize(
    ("given", "when", "expected"),
    [
        ("", "", "True True False"),
        ("", "early", "False False True"),
        ("--xla_backend_extra_options=xla_cpu_x=1", "", "False False True"),
    ],
)
def test_flags_are_set_before_anything_is_computed_or_left_alone(given, when, expected):
    env = os.environ | {"XLA_FLAGS": given}
    command = [sys.executable, "-c", PROGRAM, when]
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == expected


def flags_after(given, monkeypatch, installed="0.10.2"):
    """`XLA_FLAGS` of a process that has computed nothing yet."""
    monkeypatch.setattr(flags, "_backend_is_running", lambda: False)
    monkeypatch.setattr(importlib.metadata, "version", lambda name: installed)
    monkeypatch.setenv("XLA_FLAGS", given)
    assert fx.use_fast_cpu()
    return os.environ["XLA_FLAGS"].split()


def test_flags_of_your_own_are_left_alone(monkeypatch):
    own = "--xla_backend_optimization_level=3", "--xla_cpu_multi_thread_eigen=false"
    found = flags_after(" ".join(own), monkeypatch)
    assert found[:2] == list(own)
    names = [flag.split("=")[0] for flag in found]
    assert len(set(names)) == len(names)
    assert "--xla_cpu_prefer_vector_width" in names


@pytest.mark.parametrize(
    ("installed", "known"),
    [("0.11.0", True), ("0.11.2", False), ("0.12.0.1", False), ("0.13.0rc1", False)],
)
def test_later_versions_are_told_nothing_that_they_may_not_know(
    installed, known, monkeypatch
):
    found = flags_after("", monkeypatch, installed)
    assert any("fusion_emitters" in flag for flag in found) == known


KEEP = """
import sys
import frictionjax as fx
print(fx.keep_compiled(sys.argv[1]))
import jax
print(jax.config.jax_compilation_cache_dir)
"""


def test_a_folder_for_programs_may_be_a_text(tmp_path):
    command = [sys.executable, "-c", KEEP, str(tmp_path / "kept")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    told, by_jax = map(Path, done.stdout.split())
    # A folder of their own, as the oldest files in it go.
    assert told == tmp_path / "kept"
    assert by_jax.parent == told / "programs"


CROWD = """
import sys
import frictionjax as fx
from frictionjax._compile import program_cache
program_cache._MOST = 1
fx.keep_compiled(sys.argv[1])
"""


def test_files_of_others_in_the_folder_stay(tmp_path):
    own = [tmp_path / name for name in ("a/1.txt", "a/2.txt", "b/3.txt")]
    for path in own:
        path.parent.mkdir(exist_ok=True)
        path.write_text("mine")
    subprocess.run([sys.executable, "-c", CROWD, str(tmp_path)], check=True)
    assert all(path.exists() for path in own)


@pytest.mark.parametrize("folder", ["", 3, True, b"kept"])
def test_what_names_no_folder_is_refused(folder):
    with pytest.raises(ValueError, match=r"folder = .*: needs the path of a folder"):
        fx.keep_compiled(folder)
