"""Tests run in 64 bits, like everything that uses the library."""

import atexit
import gc
import os
import shutil
import sys
import tempfile

# Workers share what they compile: a tenth of the time.
if "JAX_COMPILATION_CACHE_DIR" not in os.environ:
    _CACHE = os.environ["JAX_COMPILATION_CACHE_DIR"] = tempfile.mkdtemp()
    os.environ["JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS"] = "0.1"
    atexit.register(shutil.rmtree, _CACHE, ignore_errors=True)

# Two workers have a core each: threads of BLAS wait for one another, 33 of the 53 CPU s
# that tests/stochastic/test_smoluchowski.py took. Has to stand before NumPy is imported.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import jax
from contexts_shared import share_contexts
from jaxtyping import install_import_hook

import frictionjax as fx

# Programs that users run. Has to stand before JAX computes anything. That values do not
# depend on flags: tests/hard/test_hard_flags.py.
fx.use_fast_cpu()

# With SHAPES_CHECKED=1 shapes that functions and records of these packages are annotated
# with are checked at every call. A sixth more of CPU: tests/test_shapes.py does so for a
# few files. Has to stand before the library is imported.
SHAPES_CHECKED = (
    "frictionjax.certificate",
    "frictionjax.convergence",
    "frictionjax.design.common",
    "frictionjax.limit",
    "frictionjax.measured",
    "frictionjax.model",
    "frictionjax.numerics",
    "frictionjax.profiles",
    "frictionjax.slide_laws",
    "frictionjax.sweeps",
    "frictionjax.wiggly.equation",
    "frictionjax.wiggly.limit_path",
    "frictionjax.wiggly.rosenbrock",
    "frictionjax.wiggly.sequential",
)
if os.environ.get("SHAPES_CHECKED"):
    install_import_hook(SHAPES_CHECKED, "shape_checks.shapes_checked")

jax.config.update("jax_enable_x64", True)
# As test suites have it of libraries that users build on: what is traced here tells every
# rank, or raises.
jax.config.update("jax_numpy_rank_promotion", "raise")
share_contexts()

# What JAX traces is many small objects, few of them garbage. (Looking through them took 4%
# of the suite.)
gc.set_threshold(20_000, 20, 50)

# Folders that take longest, first: the last one under way then leaves no worker idle.
_LONGEST = (
    "model",
    "sweeps",
    "tables",
    "certificate",
    "wiggly/sequential",
    "design/surface",
    "test_examples",
    "stochastic",
    "cost",
    "principle",
    "hard",
    "explain",
    "wiggly",
    "design/slide",
    "effects",
    "numerics",
    "wiggly/sums",
    "loads",
    "design/bristle",
    "design/trace",
    "report",
    "_compile",
    "profiles",
    "_checks",
    "studies",
    "test_cli",
    "wiggly/slip_map",
    "contact",
    "crawling",
    "called_for",
    "plot",
    "limit",
    "design/common",
    "rods",
    "wiggly/inertial",
    "explore",
)


def _folder(nodeid):
    """The folder of a test below `tests`; the file, of those in none."""
    file = nodeid.partition("::")[0].removeprefix("tests/").removesuffix(".py")
    return file.rpartition("/")[0] or file


def pytest_xdist_make_scheduler(config, log):
    """A worker takes a folder at a time: files of one share what they compile."""
    from xdist.scheduler import LoadScopeScheduling

    class LoadFolderScheduling(LoadScopeScheduling):
        def _split_scope(self, nodeid):
            return _folder(nodeid)

    return LoadFolderScheduling(config, log)


def pytest_collection_modifyitems(items):
    def turn(item):
        name = _folder(item.nodeid)
        return _LONGEST.index(name) if name in _LONGEST else len(_LONGEST)

    items.sort(key=turn)  # stable: the order inside files stays


def _loops_compiled():
    """Compiled loops of lanes in this process, as texts."""
    loops = sys.modules.get("frictionjax.wiggly.lanes.loops")
    known = loops._LOOPS._done if loops else ()
    return [f"{room} {kind}" for kind, room in known]


_LOOPS_OF_WORKERS: set = set()


def pytest_sessionfinish(session):
    output = getattr(session.config, "workeroutput", None)
    if output is not None:
        output["loops"] = _loops_compiled()
    coverage = sys.modules.get("coverage")
    measured = coverage.Coverage.current() if coverage else None
    if measured is not None:  # workers of some GB take longer to end than they are given
        measured.save()


def pytest_testnodedown(node, error):
    _LOOPS_OF_WORKERS.update(getattr(node, "workeroutput", {}).get("loops", ()))


def pytest_terminal_summary(terminalreporter):
    """How many loops all scenes of the suite took, and for which parts."""
    found = sorted(_LOOPS_OF_WORKERS.union(_loops_compiled()))
    if found:
        terminalreporter.write_line(f"{len(found)} loops of lanes compiled")
    if terminalreporter.config.getoption("verbose") > 0:
        for text in found:
            terminalreporter.write_line(f"  {' '.join(text.split())}")
