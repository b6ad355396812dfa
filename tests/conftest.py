"""Tests run in 64 bits, like everything that uses the library."""

import atexit
import os
import shutil
import tempfile

# Two thirds of the suite are compilation, which takes half as long without LLVM's passes
# and XLA's newer emitters: whole files 138 s of CPU for 252, 147 for 195. Has to stand
# before JAX starts. That values do not depend on it: tests/hard/test_hard_flags.py.
os.environ.setdefault(
    "XLA_FLAGS", "--xla_backend_optimization_level=0 --xla_cpu_use_fusion_emitters=false"
)

# Workers share what they compile: a tenth of the time.
if "JAX_COMPILATION_CACHE_DIR" not in os.environ:
    _CACHE = os.environ["JAX_COMPILATION_CACHE_DIR"] = tempfile.mkdtemp()
    os.environ["JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS"] = "0.3"
    atexit.register(shutil.rmtree, _CACHE, ignore_errors=True)

import jax

jax.config.update("jax_enable_x64", True)

# Files that take longest, first: the last one under way then leaves no worker idle.
_LONGEST = (
    "test_gradients",
    "test_strip_excess",
    "test_survey",
    "test_fit_trace",
    "test_guarantees",
    "test_cost",
    "test_few_wells",
    "test_sweep",
    "test_fit_profile",
    "test_certificate",
    "test_slide_profile",
    "test_potential",
    "test_fit_angle",
    "test_friction",
    "test_wells",
    "test_windows",
    "test_hard_flags",
    "test_hard_accuracy",
)


def pytest_collection_modifyitems(items):
    def turn(item):
        name = item.path.stem
        return _LONGEST.index(name) if name in _LONGEST else len(_LONGEST)

    items.sort(key=turn)  # stable: the order inside files stays
