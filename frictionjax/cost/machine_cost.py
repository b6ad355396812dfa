"""What work costs on this machine: measured once, kept in the cache folder."""

import contextlib
import json
import os
import platform
import resource
import sys
import time
import warnings
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from platformdirs import user_cache_path

from .._checks import as_real, cells_of, write_whole
from ..bristles import VerticalSpring
from ..loads import Sine as SineLoad
from ..model import Scene
from ..profiles import Sine
from ..supports import Spring
from ..sweeps import sweep
from ..wiggly import Workload, workload
from .settings import SETTINGS


class MachineCost(NamedTuple):
    """Seconds of the parts of a sweep, and the memory that any takes.

    `call`: once; `cell`: each; `job`: a lane that sets off; `step`: of one lane, both
    cores busy; `chain`: a step that others wait for. `compilation`: what the first of the
    measured runs took longer. `memory`: bytes before anything large. `measured`: whether
    on this machine.
    """

    call: float
    cell: float
    job: float
    step: float
    chain: float
    compilation: float
    memory: float
    measured: bool = True

    def seconds(self, work: Workload) -> float:
        """Time of a sweep of these cells."""
        return float(np.dot(self[:5], _amounts(work)))


_REVISION = 3  # of `measure_machine`: what others have kept is not read
_UNWRITTEN: dict[str, MachineCost] = {}  # where the cache folder cannot be written


# Two cores of a server, 2026, as measured: for whoever cannot wait for a measurement.
ELSEWHERE = MachineCost(0.023, 0.0081, 0.0, 8.4e-8, 6.6e-7, 9.3, 7.7e8, measured=False)


def _amounts(work: Workload) -> np.ndarray:
    """How much of each part a sweep has, in the order of `MachineCost`."""
    steps = work.weight * work.steps.sum()
    chain = work.weight * work.chain.max(initial=0.0)
    calls = (
        1
        + SETTINGS.piece_calls * work.pieces
        + SETTINGS.map_calls * work.maps.sum()
        + SETTINGS.round_calls * work.rounds.max(initial=0.0)
    )
    return np.array([calls, work.steps.size, work.jobs.sum(), steps, chain])


# Sweeps that differ in what they have most of: eps, gamma, method.
_RUNS: tuple[tuple[Any, Any, str], ...] = (
    ((0.1,), (1.0,), "auto"),  # calls
    ((0.05, 0.02), (1.0, 2.0), "auto"),  # cells
    ((1e-3,), (1.0,), "auto"),  # jobs
    ((1e-3, 1e-4, 1e-5, 1e-6), (1.0, 2.0), "auto"),
    ((1e-3,), (1.0, 2.0), "resolved"),  # steps
    ((2.5e-3,), (0.5,), "auto"),  # one lane, which goes through all
    ((1e-3,), (0.5,), "auto"),  # slip maps
)


def _example() -> Scene:
    one, two = as_real(1.0), as_real(2.0)
    bristle, load = VerticalSpring(one, two, one), SineLoad(as_real(1.0488), as_real(3.0))
    return Scene(Sine(as_real(0.1)), bristle, Spring(one), load, duration=3.0)


def _clocked(scene: Scene, eps: Any, gamma: Any, method: str) -> tuple[float, float]:
    """Seconds of the fastest warm run, and how much longer the first took."""
    ts, spent = np.linspace(0, 3, SETTINGS.machine_times), []
    for _ in range(1 + SETTINGS.repeats):
        begun = time.perf_counter()
        sweep(scene, np.array(eps), np.array(gamma), ts, 1e-3, method)
        spent.append(time.perf_counter() - begun)
    best = min(spent[1:])
    return best, max(0.0, spent[0] - best)


def measure_machine() -> MachineCost:
    """Time a few sweeps, 3 s and compilation of 15 s, and fit the parts to them.

    Non-negative least squares of relative errors: of absolute ones the longest run decides
    alone. What this process had in memory before does not count; one that had compiled all
    shows neither compilation nor memory, and both stay those of another machine.
    """
    from scipy.optimize import nnls  # 0.2 s, once

    scene = _example()
    before = _resident_bytes()
    rows, seconds, compilation = [], [], 0.0
    for eps, gamma, method in _RUNS:
        lane_eps, lane_gamma = cells_of(eps, gamma)
        work = workload(scene, lane_eps, lane_gamma, SETTINGS.machine_times, 1e-3, method)
        assert work is not None
        best, longer = _clocked(scene, eps, gamma, method)
        rows.append(_amounts(work))
        seconds.append(best)
        compilation += longer
    shares = np.array(rows) / np.array(seconds)[:, None]
    scale = shares.max(axis=0)
    parts = nnls(shares / scale, np.ones(len(seconds)))[0] / scale
    # Relative errors are smallest for parts too small: their logarithms have no such bias.
    parts *= np.exp(-np.mean(np.log(shares @ parts)))
    call, cell, job, step, chain = map(float, parts)
    memory = SETTINGS.imported_bytes + max(0.0, _resident_bytes() - before)
    if compilation < SETTINGS.warm:
        compilation, memory = ELSEWHERE.compilation, ELSEWHERE.memory
    return MachineCost(call, cell, job, step, chain, compilation, memory)


def _resident_bytes() -> float:
    """Memory of this process: now, or the most so far where the system tells no more.

    (A peak is what the process had done before: 3.6 GB, once, for every later prediction.)
    """
    with contextlib.suppress(OSError, ValueError, IndexError):
        pages = Path("/proc/self/statm").read_text(encoding="ascii").split()[1]
        return float(int(pages) * resource.getpagesize())
    unit = 1 if sys.platform == "darwin" else 1024
    return float(unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


def _key() -> str:
    """What a measurement holds for: how it was made, versions, machine by its network
    name, flags."""
    packages = [f"{name} {version(name)}" for name in ("frictionjax", "jax")]
    flags = os.environ.get("XLA_FLAGS", "")
    # A home folder may be shared by machines.
    machine = f"{platform.node()} {platform.machine()}, {os.cpu_count()} cores"
    return ", ".join([f"measurement {_REVISION}", *packages, machine, flags])


def _file(folder: Path | None) -> Path:
    return (folder or user_cache_path("frictionjax")) / "cost.json"


def _kept(folder: Path | None) -> dict[str, Any]:
    """What is in the file; nothing where it is not there or spoiled."""
    try:
        found = json.loads(_file(folder).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}


def known_machine(folder: Path | None = None) -> MachineCost | None:
    """The measurement of this machine, versions and XLA flags; None where there is none."""
    kept = _kept(folder).get(_key())
    names = MachineCost._fields[:-1]
    if not isinstance(kept, dict) or not all(_is_size(kept.get(name)) for name in names):
        return None
    if not any(kept[name] for name in names[:5]):  # nothing costs nothing
        return None
    return MachineCost._make([*(float(kept[name]) for name in names), True])


def _is_size(value: Any) -> bool:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and 0 <= value < SETTINGS.absurd


def machine_cost(folder: Path | None = None, again: bool = False) -> MachineCost:
    """The costs of this machine, measured where they are not known yet, or `again`.

    They are kept in `folder`, the user's cache folder where it is None; where that cannot
    be written, for this process, with a warning.
    """
    found = None if again else known_machine(folder) or _UNWRITTEN.get(_key())
    if found is None:
        found = measure_machine()
        try:
            keep_machine(found, folder)
        except OSError as error:
            _UNWRITTEN[_key()] = found
            said = f"what this machine costs is measured again next time: {error}"
            warnings.warn(said, stacklevel=2)
    return found


def keep_machine(found: MachineCost, folder: Path | None = None) -> None:
    """Write a measurement beside those of other versions and flags."""
    path = _file(folder)
    path.parent.mkdir(parents=True, exist_ok=True)
    values = dict(zip(MachineCost._fields[:-1], found[:-1], strict=True))
    text = json.dumps(_kept(folder) | {_key(): values}, indent=1)
    write_whole(path, text + "\n")
