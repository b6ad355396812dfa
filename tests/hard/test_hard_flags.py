"""What the compiler is told matters neither to values, statuses nor, much, to memory."""

import os
import platform
import subprocess
import sys
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest
from catalogue import HARD
from smallest_eps import SMALLEST

import frictionjax as fx
from frictionjax._compile.flags import fast_cpu_flags

USERS = " ".join(fast_cpu_flags())
"""Those of the suite too, see conftest.py."""
_EMITTERS = [flag for flag in fast_cpu_flags() if "fusion_emitters" in flag]
QUICK = " ".join(["--xla_backend_optimization_level=0", *_EMITTERS])
_HERE = Path(__file__).parent
_MODULES = os.pathsep.join([str(_HERE), str(_HERE.parent / "support")])

_SCRIPT = """
import sys, jax
jax.config.update("jax_enable_x64", True)
import numpy as np
from test_hard_flags import values_of
path, *names = sys.argv[1:]
np.savez(path, **{name.replace("/", "|"): values_of(name) for name in names})
"""


def values_of(name):
    """z in eps, and the dissipation over its last value."""
    one = HARD[name]
    run = fx.solve(one.build(), one.eps, one.gamma, one.ts)
    assert run.ok, (name, run.status.message)
    return np.stack([run.z / one.eps, run.dissipation / run.dissipation[-1]])


def values_with(flags, names, path):
    env = os.environ | {"XLA_FLAGS": flags, "PYTHONPATH": _MODULES}
    subprocess.run([sys.executable, "-c", _SCRIPT, path, *names], check=True, env=env)
    return {name.replace("|", "/"): value for name, value in np.load(path).items()}


def test_values_do_not_depend_on_optimisation(tmp_path):
    names = ["two folds", "kinks and plateaus"]
    found = values_with(QUICK, names, tmp_path / "quick.npz")
    for name in names:
        assert np.abs(found[name] - values_of(name)).max() < 1e-6, name


@pytest.mark.slow
def test_compiler_flags_do_not_matter_in_any_scene(tmp_path):
    flags = {"plain": "", "fast": USERS, "quick": QUICK}
    found = {
        name: values_with(value, list(HARD), tmp_path / f"{name}.npz")
        for name, value in flags.items()
    }
    for scene, values in found["plain"].items():
        for name in ("fast", "quick"):
            assert np.abs(found[name][scene] - values).max() < 1e-6, (name, scene)


# "": all that the machine has.
_ISA = ["SSE4_2", "AVX", "AVX2", ""]
_STATUSES = """
import sys, jax
jax.config.update("jax_enable_x64", True)
import numpy as np
from smallest_eps import statuses_of
for name, gammas in zip(sys.argv[1::2], sys.argv[2::2]):
    statuses, shares = statuses_of(name, [float(g) for g in gammas.split()])
    print(name, "|", statuses.max(), "|", np.nanmax(shares))
"""


def require_ok(flags: str, isa: str, gammas: dict[str, str]) -> None:
    """Every cell is OK, its residual a third of what that allows at most."""
    chosen = f"{flags} --xla_cpu_max_isa={isa}" if isa else flags
    env = os.environ | {"XLA_FLAGS": chosen, "PYTHONPATH": _MODULES}
    command = [sys.executable, "-c", _STATUSES, *sum(gammas.items(), ())]
    done = subprocess.run(command, check=True, env=env, capture_output=True, text=True)
    lines = [line.split("|") for line in done.stdout.splitlines()]
    assert len(lines) == len(gammas)
    for name, status, share in lines:
        assert int(status) == fx.Status.OK, name
        assert float(share) < 1 / 3, (name, share)


@pytest.mark.skipif(platform.machine() != "x86_64", reason="its instruction sets")
@pytest.mark.slow
def test_the_smallest_eps_is_ok_without_the_instructions_of_this_machine():
    """It was UNBALANCED with AVX2: a tip rested where it was unstable."""
    require_ok(QUICK, "AVX2", {"turns on a fold": "1 2"})


@pytest.mark.slow
@pytest.mark.skipif(platform.machine() != "x86_64", reason="its instruction sets")
@pytest.mark.parametrize("isa", _ISA)
@pytest.mark.parametrize("flags", [QUICK, USERS], ids=["quick", "users"])
def test_smallest_eps_are_ok_with_all_instructions(flags, isa):
    require_ok(flags, isa, dict.fromkeys(SMALLEST, "0.75 1 1.5 2"))


_STATUS = Path("/proc/self/status")  # of Linux
_COMPILED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_DATA, (8 * 2**30, 8 * 2**30))
import jax
jax.config.update("jax_enable_x64", True)
import numpy as np
import frictionjax as fx
from springs import Spring, scene_of
k = np.arange(1, int(sys.argv[1]) + 1)
cos = 0.1 / k**4 / (2 * np.pi * np.sum(1.0 / k**3))
scene = scene_of(Spring("", surface=(cos, 0.3 * cos)))
data = fx.sweep(scene, [1e-3], [0.5], np.linspace(0, 3, 61))  # wide and narrow loops
assert int(data.status.max()) == 0, data.status.values
# Not ru_maxrss: it is that of the process that started this one, where that was larger.
print(next(line.split()[1] for line in open("/proc/self/status") if "VmHWM" in line))
"""


@pytest.mark.slow
@pytest.mark.skipif(not _STATUS.exists(), reason="the peak of a process is read in /proc")
@pytest.mark.parametrize("harmonics", [8, 16, 33])
def test_compilation_with_fast_flags_takes_little_memory(harmonics):
    # Sums of 14 and 16 harmonics, written out, took LLVM more than 20 GB, and so did 8
    # beside a load that may be a sine.
    env = os.environ | {"XLA_FLAGS": USERS, "PYTHONPATH": _MODULES}
    env.pop("JAX_COMPILATION_CACHE_DIR", None)
    command = [sys.executable, "-c", _COMPILED, str(harmonics)]
    done = subprocess.run(command, check=True, env=env, capture_output=True, text=True)
    assert float(done.stdout) < 2 * 2**20  # kB


def test_tests_run_where_no_rank_is_promoted():
    """All that they trace of the library is looked at by that, see conftest.py."""
    with pytest.raises(ValueError, match="rank_promotion"):
        jnp.ones((2, 2)) * jnp.ones(2)
