"""How XLA compiles and what it keeps: set by the command line, offered to notebooks.

Imports no JAX at the top: the flags must be set before it.
"""

import os
import re
import sys
from pathlib import Path

# Small loops are compiled as one function, not as a list of kernels, and with vectors of
# the full width: a step of one of 64 lanes takes 0.05 us for 0.09.
_LOOPS = "--xla_backend_extra_options=xla_cpu_small_while_loop_byte_threshold=1000000000"
# LLVM's first level and XLA's older emitters compile a first solve in 4.4 s for 7.6 (the
# level alone 5.4, the emitters alone 6.1, level 0 with both 2.8); steps take as long, at
# level 0 four times. Of the older emitters 0.11.0 knows, 0.11.2, 0.12.0 and 0.12.0.1 end
# the process at the flag, as at all that they do not know.
_QUICK = "--xla_backend_optimization_level=1"
_BRIEF = {"xla_backend_optimization_level": 0}
_OLDER = "--xla_cpu_use_fusion_emitters=false"
_OLDER_UNTIL = (0, 11, 1)  # jaxlib
_WORTH_KEEPING = 0.0  # s of compilation: small programs add up to 2 s of a study


def fast_cpu_flags() -> list[str]:
    """What `use_fast_cpu` adds to `XLA_FLAGS`, for the jaxlib that is installed."""
    from importlib.metadata import version  # 50 ms, which jax takes anyway

    numbers = re.findall(r"\d+", version("jaxlib"))  # also of 0.13.0rc1
    early = tuple(map(int, numbers[:3])) < _OLDER_UNTIL
    flags = [_LOOPS, "--xla_cpu_prefer_vector_width=512", _QUICK]
    return [*flags, _OLDER] if early else flags


def brief_options() -> dict[str, int] | None:
    """How to compile what seldom runs, where the level is ours to choose."""
    return _BRIEF if _QUICK in os.environ.get("XLA_FLAGS", "").split() else None


def use_fast_cpu() -> bool:
    """Set the flags with which XLA compiles the library's loops best on a CPU.

    And have programs run in the thread that calls them (`jax_cpu_enable_async_dispatch`).
    Call it before anything has been computed with JAX in the process; later calls, and
    flags of your own in `XLA_FLAGS`, are left alone. Returns whether the flags are in use
    or will be.

    >>> import os
    >>> in_use = fx.use_fast_cpu()
    >>> [flag for flag in os.environ["XLA_FLAGS"].split() if in_use and "vector" in flag]
    ['--xla_cpu_prefer_vector_width=512']
    """
    given = os.environ.get("XLA_FLAGS", "")
    if _backend_is_running():
        return _LOOPS in given
    if _LOOPS not in given:
        if "xla_backend_extra_options" in given:
            return False
        names = [flag.split("=")[0] for flag in given.split()]
        more = [f for f in fast_cpu_flags() if f.split("=")[0] not in names]
        os.environ["XLA_FLAGS"] = " ".join([*given.split(), *more])
    import jax

    # A small program takes 20 us where handing it to another thread takes 80.
    jax.config.update("jax_cpu_enable_async_dispatch", False)
    return True


def _backend_is_running() -> bool:
    bridge = sys.modules.get("jax._src.xla_bridge")
    return bool(bridge and getattr(bridge, "_backends", None))


def keep_compiled(folder: str | os.PathLike | None = None) -> Path:
    """Keep compiled programs in `folder`, the user's cache folder where it is None.

    A folder that cannot be written, or a full disk, is one warning, and nothing more is
    kept. Returns the folder.

    Raises `ValueError` for what names no folder.

    >>> print(fx.keep_compiled("compiled"))
    compiled
    """
    known = folder is None or (isinstance(folder, str | os.PathLike) and str(folder))
    if not known:
        raise ValueError(f"folder = {folder!r}: needs the path of a folder, or None")
    import jax
    from platformdirs import user_cache_path

    from .program_cache import keep_in

    place = user_cache_path("frictionjax") / "xla" if folder is None else Path(folder)
    jax.config.update("jax_persistent_cache_min_compile_time_secs", _WORTH_KEEPING)
    # JAX's own cache beside: what it has given cannot be kept in the other, and where one
    # was emptied both have to be. Both in a folder of their own, as the oldest files in it
    # go, and the user's folder may hold others.
    found = keep_in(place / "programs")
    if found is not None:
        jax.config.update("jax_compilation_cache_dir", str(found))
    return place
