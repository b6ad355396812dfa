"""Programs kept in a folder as they were compiled, so that later processes only load them.

JAX's own cache keeps what XLA makes of a program, found by the program's text: tracing and
lowering come first, and were 2 s of the 6.5 s of a warm study. (Programs kept as they were
traced are lowered once more, which takes most of the time of fetching them.) A program is
found by the library's source, by the processor and by what it is called with: constants of
modules that a running process has changed are not seen.
"""

import contextlib
import functools
import hashlib
import io
import os
import pickle
import sys
import sysconfig
import threading
import warnings
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
from jax.experimental.serialize_executable import deserialize_and_load, serialize

from .._checks import write_whole
from .processor import processor

# Where what belongs to a program may come from: a user's function or class can change
# while its name stays the same.
_OURS = __name__.partition(".")[0]
_TRUSTED = {_OURS, "builtins", "collections", "equinox", "jax", "jaxlib", "numpy"}
_MOST = 1000  # files in the folder; the oldest go first
_PROBE = 4096  # bytes
_NEVER = 1e9  # s of compilation from which on JAX keeps a program
# Of other libraries' code a program holds an address, which loading does not fill in.
_CALL = "stablehlo.custom_call"
_FOUND = "/jax/compilation_cache/cache_hits"
_place: Path | None = None
_writes = True  # until something could not be written


class _Fetched(threading.local):
    """How many programs JAX's own cache has given this thread."""

    count = 0

    def note(self, event: str, **_: Any) -> None:
        """One more, if that is what an event of JAX tells."""
        self.count += event == _FOUND


_FETCHED = _Fetched()


@functools.cache
def _listen() -> None:
    jax.monitoring.register_event_listener(_FETCHED.note)


def keep_in(folder: Path) -> Path | None:
    """Keep the programs that are compiled from now on in a folder.

    Returns where in it, which is a place of its own for each version of the library; None
    where it cannot be written: what is in it is used, and one warning says so.
    """
    global _place, _writes
    _place, _writes = folder / _stamp_at_first(), True
    _listen()
    _try_to_write(_place / f"probe-{os.getpid()}", bytes(_PROBE))
    with contextlib.suppress(OSError):
        (_place / f"probe-{os.getpid()}").unlink()
    return _place if _place.is_dir() else None


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
    """Of this library's source, the packages installed beside it and the processor."""
    found = hashlib.sha256(processor().encode())
    for path in sorted(Path(__file__).parents[1].rglob("*.py")):
        found.update(path.read_bytes())
    installed = Path(sysconfig.get_path("purelib")).glob("*.dist-info")
    versions = sys.version, jax.__version__, eqx.__version__
    found.update(repr((versions, sorted(p.name for p in installed))).encode())
    return found.hexdigest()[:32]


@functools.cache
def _stamp_at_first() -> str:
    """Of the source that this process runs: 20 to 30 ms (by hand) for each command."""
    return _stamp()


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
    settings.append(os.environ.get("XLA_FLAGS", ""))
    name = fn.__module__, fn.__qualname__, settings
    file = io.BytesIO()
    tree = jax.tree_util.tree_unflatten(structure, leaves)
    _Describer(file, protocol=5).dump((name, [i for i, _ in rest], tree))
    return file.getvalue()


def kept(
    fn: Callable, run: Callable, structure: Any, rest: tuple, options: dict | None = None
) -> Callable:
    """`jax.jit(run)`, fetched from the folder where programs are kept, or put there.

    `run` takes a list of arrays. `fn` of the library, called with the tree `structure` in
    which the leaves `rest` are no arrays, says which program it is. `options`: of XLA's.
    """
    jitted = jax.jit(run)
    checked = [getattr(jax.config, f"jax_{name}") for name in ("disable_jit", "debug_nans")]
    if any(checked) or not _alone():
        return jitted
    try:
        what = _described(fn, structure, rest) + repr(options).encode()
    except Exception:  # what cannot be described is not kept: it may hold traced numbers
        return jitted
    return _Kept(jitted, options, what, _place)


def _alone() -> bool:
    """Whether arrays can only be where programs from the folder run."""
    return jax.default_backend() == "cpu" and jax.device_count() == 1


class _Kept:
    """A program, fetched or compiled once for each set of shapes.

    Also where there is no folder: rules of derivatives are called while JAX traces, which
    takes a program apart that it could call (3 s for the first derivative of a slide).
    """

    def __init__(
        self,
        jitted: Callable,
        options: dict | None,
        what: bytes,
        place: Path | None,
    ):
        self._jitted, self._options = jitted, options
        self._what, self._place = what, place
        self._known: dict[tuple, Callable] = {}
        self._lock = threading.Lock()  # several threads compile a program once

    def __call__(self, numbers: list) -> Any:
        # Programs from the folder know no derivatives or batches, and those that are
        # compiled cannot be run without `jax.jit`, which may be off since.
        off = jax.config.jax_disable_jit  # type: ignore[attr-defined]
        if off or any(isinstance(x, jax.core.Tracer) for x in numbers):
            return self._jitted(numbers)
        shapes = tuple([(x.shape, x.dtype) for x in numbers])
        program = self._known.get(shapes)
        if program is None:
            with self._lock:
                program = self._known.get(shapes)
                if program is None:
                    return self._first(numbers, shapes)
        return program(numbers)

    def _first(self, numbers: list, shapes: tuple) -> Any:
        if self._place is None:
            lowered, structures = _lowered(self._jitted, numbers, self._options)
            self._known[shapes] = program = _called(lowered.compile(), structures[0])
            return program(numbers)
        name = hashlib.sha256(self._what + repr(shapes).encode()).hexdigest()
        path = self._place / f"{name[:40]}.bin"
        with contextlib.suppress(Exception):  # no such file, or one that is of no use
            program = _loaded(path.read_bytes())
            found = jax.block_until_ready(program(numbers))
            self._known[shapes] = program
            return found
        self._known[shapes] = program = self._made(numbers, path)
        return program(numbers)

    def _made(self, numbers: list, path: Path) -> Callable:
        try:
            data, program = _compiled(self._jitted, numbers, self._options)
        except Exception:  # not every program can be written down
            return self._jitted
        if data is not None:
            _try_to_write(path, data)
        return program


def _lowered(jitted: Callable, numbers: list, options: dict | None) -> tuple[Any, list]:
    """A program of flat results, lowered, and a list of their one structure."""
    structures: list = []

    def flat(numbers: list) -> list:
        leaves, structure = jax.tree_util.tree_flatten(jitted(numbers))
        structures.append(structure)
        return leaves

    flat.__name__ = jitted.__name__  # as profilers and logs of compilations call it
    return jax.jit(flat, compiler_options=options).lower(numbers), structures


def _compiled(
    jitted: Callable, numbers: list, options: dict | None = None
) -> tuple[bytes | None, Callable]:
    """A program as a file and as a function; no file of what JAX's cache has given.

    Such a program cannot be written down once more: it lacks its code.
    """
    lowered, structures = _lowered(jitted, numbers, options)
    if _CALL in lowered.as_text():
        raise _ForeignError(f"{jitted.__name__} calls another library")
    fetched = _FETCHED.count
    whole, out = lowered.compile(), structures[0]
    program = _called(whole, out)
    if _FETCHED.count > fetched:
        return None, program
    example = jax.tree_util.tree_unflatten(out, range(out.num_leaves))
    return zlib.compress(pickle.dumps((serialize(whole), example)), level=1), program


def _loaded(data: bytes) -> Callable:
    """The program in a file, which a process of this user wrote."""
    whole, example = pickle.loads(zlib.decompress(data))
    return _called(deserialize_and_load(*whole), jax.tree_util.tree_structure(example))


def _called(whole: Callable, out: Any) -> Callable:
    def program(numbers: list) -> Any:
        return jax.tree_util.tree_unflatten(out, whole(numbers))

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
