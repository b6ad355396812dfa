"""What the process around the library must be: able to run JAX, and not forked after it."""

import functools
import os
import sys
from collections.abc import Callable
from typing import ParamSpec, TypeVar

import jax

_P = ParamSpec("_P")
_T = TypeVar("_T")
_known = {"ready": False, "forked": False}


class SurroundingsError(RuntimeError):
    """The process cannot compute with JAX; the text says what to do."""


def require_ready() -> None:
    """Raise where JAX cannot compute: its platform is not there, or the process forked.

    A dictionary is looked up: 0.1 us, where asking JAX for its devices takes 2.
    """
    if _known["forked"]:
        raise SurroundingsError(
            "fork: JAX had computed in the process that this one was forked from, and "
            "would wait for its threads for ever; start processes with multiprocessing's "
            '"spawn" or "forkserver", or fork before anything is computed'
        )
    if not _known["ready"]:
        _require_platform()
        _known["ready"] = True


def _require_platform() -> None:
    try:
        jax.devices()
    # Of a platform that is known but not built in, JAX 0.10 says nothing but `assert`.
    except (RuntimeError, AssertionError) as problem:
        asked = jax.config.jax_platforms  # type: ignore[attr-defined]
        reason = str(problem).partition(". ")[0].partition(" (set ")[0]
        said = f" ({reason})" if reason else ""
        raise SurroundingsError(
            f"jax_platforms = {asked!r}: JAX cannot start there{said}; unset JAX_PLATFORMS "
            'or set it to "cpu", or install jax for that platform, as "jax[cuda13]"'
        ) from None


def _after_fork() -> None:
    bridge = sys.modules.get("jax._src.xla_bridge")
    _known["forked"] |= bool(bridge and getattr(bridge, "_backends", None))


if hasattr(os, "register_at_fork"):  # nothing forks on Windows
    os.register_at_fork(after_in_child=_after_fork)


def with_nan(fn: Callable[_P, _T]) -> Callable[_P, _T]:
    """`fn` with `jax_debug_nans` and `jax_debug_infs` off: here NaN stands for no value.

    A caller's own functions are looked at as before, and so is what `fn` returns to their
    `jit`. The flags are of a thread: other threads need this too.
    """

    @functools.wraps(fn)
    def call(*args: _P.args, **kwargs: _P.kwargs) -> _T:
        if not is_debugged():
            return fn(*args, **kwargs)
        with jax.debug_nans(False), jax.debug_infs(False):
            return fn(*args, **kwargs)

    return call


def is_debugged() -> bool:
    """Whether JAX looks for NaN or inf in every result."""
    # The attributes are made at run time: types do not know of them.
    nans = jax.config.jax_debug_nans  # type: ignore[attr-defined]
    return bool(nans or jax.config.jax_debug_infs)  # type: ignore[attr-defined]
