"""Settings of XLA that are made before JAX has computed anything."""

import os
import subprocess
import sys

import pytest

import frictionjax as fx

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
    assert done.stdout.split() == 2 * [str(tmp_path / "kept")]


@pytest.mark.parametrize("folder", ["", 3, True, b"kept"])
def test_what_names_no_folder_is_refused(folder):
    with pytest.raises(ValueError, match=r"folder = .*: needs the path of a folder"):
        fx.keep_compiled(folder)
