"""Programs kept in a folder as they were traced, so that later processes only load them.

JAX's own cache keeps what XLA makes of a program, found by the program's text: tracing and
lowering come first, and were 2 s of the 6.5 s of a warm study. A program is found by the
library's source and by what it is called with: constants of modules that a running process
has changed are not seen.
"""

import contextlib
import hashlib
import io
import os
import pickle
import sys
import sysconfig
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
from jax import export

from .._checks import write_whole

# Where what belongs to a program may come from: a user's function or class can change
# while its name stays the same.
_OURS = __name__.partition(".")[0]
_TRUSTED = {_OURS, "builtins", "collections", "equinox", "jax", "jaxlib", "numpy"}
_MOST = 300  # files in the folder; the oldest go first
_place: Path | None = None
_writes = True  # until something could not be written
_PROBE = 4096  # bytes
_NEVER = 1e9  # s of compilation from which on JAX keeps a program


def keep_in(folder: Path | None) -> None:
    """Keep the programs that are traced from now on in a folder; None: keep none.

    Where it cannot be written, what is in it is used, and one warning says so.
    """
    global _place, _writes
    _place, _writes = None if folder is None else folder / _stamp(), True
    if _place is not None:
        _try_to_write(_place / f"probe-{os.getpid()}", bytes(_PROBE))
        with contextlib.suppress(OSError):
            (_place / f"probe-{os.getpid()}").unlink()


def _try_to_write(path: Path, data: bytes) -> None:
    """Write a file; where that fails, warn once and write nothing more.

    JAX would go on, with a warning and half a file for every program.
    """
    global _writes
    if not _writes:
        return
    try:
        _write(path, data)
    except OSError as problem:
        _writes = False
        jax.config.update("jax_persistent_cache_min_compile_time_secs", _NEVER)
        said = f"compiled programs are not kept in {path.parent} ({problem.strerror}): "
        warnings.warn(said + "every process compiles them anew", stacklevel=2)


def _stamp() -> str:
    """Of this library's source and of the packages installed beside it."""
    found = hashlib.sha256()
    for path in sorted(Path(__file__).parents[1].rglob("*.py")):
        found.update(path.read_bytes())
    installed = Path(sysconfig.get_path("purelib")).glob("*.dist-info")
    versions = sys.version, jax.__version__, eqx.__version__
    found.update(repr((versions, sorted(p.name for p in installed))).encode())
    return found.hexdigest()[:32]


class _ForeignError(Exception):
    """A program holds something that its name does not pin down."""


class _Describer(pickle.Pickler):
    """Writes trees of the library's own parts and refuses everything else."""

    def reducer_override(self, obj: Any) -> Any:
        """Refuse classes and functions from elsewhere, and those without a name."""
        part = isinstance(obj, eqx.Module)  # its class is looked at in its turn
        if isinstance(obj, type) or (callable(obj) and not part):
            origin = (getattr(obj, "__module__", None) or "").partition(".")[0]
            if origin not in _TRUSTED or "<" in getattr(obj, "__qualname__", "<"):
                raise _ForeignError(repr(obj))
        return NotImplemented


def _described(fn: Callable, structure: Any, rest: tuple) -> bytes:
    """What a program is, shapes left out: equal only where programs are equal."""
    if fn.__module__.partition(".")[0] != _OURS or "<" in fn.__qualname__:
        raise _ForeignError(repr(fn))
    leaves: list = list(range(structure.num_leaves))
    for index, leaf in rest:
        leaves[index] = leaf
    names = "enable_x64", "default_matmul_precision", "numpy_dtype_promotion"
    settings = [str(getattr(jax.config, f"jax_{name}")) for name in names]
    name = fn.__module__, fn.__qualname__, settings
    file = io.BytesIO()
    tree = jax.tree_util.tree_unflatten(structure, leaves)
    _Describer(file, protocol=5).dump((name, [i for i, _ in rest], tree))
    return file.getvalue()


def kept(fn: Callable, run: Callable, structure: Any, rest: tuple) -> Callable:
    """`jax.jit(run)`, fetched from the folder where programs are kept, or put there.

    `run` takes a list of arrays. `fn` of the library, called with the tree `structure` in
    which the leaves `rest` are no arrays, says which program it is.
    """
    compiled = jax.jit(run)
    checked = [getattr(jax.config, f"jax_{name}") for name in ("disable_jit", "debug_nans")]
    # What was traced for one platform does not run on another, to which arrays may belong.
    if _place is None or any(checked) or jax.default_backend() != "cpu":
        return compiled
    try:
        what = _described(fn, structure, rest)
    except Exception:  # of any kind: what cannot be described is not kept
        return compiled
    return _Kept(compiled, what, _place)


class _Kept:
    """A program, fetched or traced once for each set of shapes."""

    def __init__(self, compiled: Callable, what: bytes, place: Path):
        self._compiled, self._what, self._place = compiled, what, place
        self._known: dict[tuple, Callable] = {}

    def __call__(self, numbers: list) -> Any:
        # Programs from the folder know no derivatives or batches.
        if any(isinstance(x, jax.core.Tracer) for x in numbers):
            return self._compiled(numbers)
        shapes = tuple([(x.shape, x.dtype) for x in numbers])
        program = self._known.get(shapes)
        if program is None:
            program = self._known[shapes] = self._found(numbers, shapes)
        return program(numbers)

    def _found(self, numbers: list, shapes: tuple) -> Callable:
        name = hashlib.sha256(self._what + repr(shapes).encode()).hexdigest()
        path = self._place / f"{name[:40]}.bin"
        with contextlib.suppress(Exception):  # no such file, or one that does not load
            return _loaded(path.read_bytes())
        try:
            data, program = _traced(self._compiled, numbers)
        except Exception:  # not every program can be written down
            return self._compiled
        _try_to_write(path, data)
        return program


def _traced(compiled: Callable, numbers: list) -> tuple[bytes, Callable]:
    """A program as a file and as a function: the same one, whoever traced it."""
    structures: list = []

    def flat(numbers: list) -> list:
        leaves, structure = jax.tree_util.tree_flatten(compiled(numbers))
        structures.append(structure)
        return leaves

    flat.__name__ = compiled.__name__  # as profilers and logs of compilations call it
    exported = export.export(jax.jit(flat))(numbers)
    out = structures[0]
    example = jax.tree_util.tree_unflatten(out, range(out.num_leaves))
    return pickle.dumps((exported.serialize(), example)), _called(exported, out)


def _loaded(data: bytes) -> Callable:
    """The program in a file, which a process of this user wrote."""
    exported, example = pickle.loads(data)
    return _called(export.deserialize(exported), jax.tree_util.tree_structure(example))


def _called(exported: export.Exported, out: Any) -> Callable:
    def run(numbers: list) -> Any:
        return exported.call(numbers)

    run.__name__ = exported.fun_name
    call = jax.jit(run)

    def program(numbers: list) -> Any:
        return jax.tree_util.tree_unflatten(out, call(numbers))

    return program


def _write(path: Path, data: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, data)
    _drop_oldest(path.parent.parent)


def _drop_oldest(folder: Path) -> None:
    """Keep the newest programs. Other processes do so too: what is gone is gone."""
    ages: list[tuple[float, Path]] = []
    for path in folder.glob("*/*"):
        with contextlib.suppress(OSError):
            ages.append((path.stat().st_mtime, path))
    for _, old in sorted(ages)[:-_MOST]:
        with contextlib.suppress(OSError):
            old.unlink()
