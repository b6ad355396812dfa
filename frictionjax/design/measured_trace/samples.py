"""A measured friction trace: force or position against time."""

import csv
import io
from pathlib import Path
from typing import Any

import numpy as np

from ..._checks import (
    as_text,
    numbers_of,
    require,
    require_real,
    require_whole,
    with_nan,
    without_masked,
    write_whole,
)
from ...effects import Engine
from ...model import Scene, require_times, scene_for
from ...wiggly import solve
from .file import TRACE_QUANTITIES, trace_columns

_LARGEST = 1e50  # N, m: squares of squares of it are numbers


class Trace:
    """What was measured at the times `ts` (s, increasing), shape (n,).

    One of `force`: `l(t) - Phi'(z)` in N, the friction of a loop, and `z`: the state in
    m. `uncertainty`: standard deviation of one sample in the same unit, a number or (n,);
    None where it is not known: then it is taken from what the fit leaves. Samples masked
    (`numpy.ma`) in any of them are left out; `masked` is their number.

    Raises `ValueError` for shapes that differ, values that are not finite, times that do
    not increase from 0 on, uncertainties that are not positive, or both quantities.

    >>> ts = np.linspace(0.0, 3.0, 301)
    >>> fx.Trace(ts, force=0.1 * np.sin(ts), uncertainty=0.01)
    Trace(force: 301 times in [0, 3] s)
    """

    def __init__(self, ts: Any, force: Any = None, z: Any = None, uncertainty: Any = None):
        given = [name for name, v in (("force", force), ("z", z)) if v is not None]
        allowed = "one of force and z"
        require(len(given) == 1, "trace", " and ".join(given) or "nothing", allowed)
        self.quantity = given[0]
        values = force if z is None else z
        (ts, values, uncertainty), self.masked = without_masked(ts, values, uncertainty)
        self.ts = numbers_of("trace.ts", ts)
        good = self.ts.ndim == 1 and self.ts.size >= 4
        said = f"{self.ts.size} times, {self.masked} masked" if self.masked else None
        allowed = "4 or more times, shape (n,)"
        require(good, "trace.ts", said or self.ts.shape, allowed)
        require(np.all(np.isfinite(self.ts)), "trace.ts", self.ts, "finite times")
        require(np.all(np.diff(self.ts) > 0), "trace.ts", self.ts, "increasing times")
        require(self.ts[0] >= 0, "trace.ts", self.ts[0], "times from 0 on")
        name = f"trace.{self.quantity}"
        self.values = numbers_of(name, values)
        shape = f"the shape {self.ts.shape} of ts"
        require(self.values.shape == self.ts.shape, name, self.values.shape, shape)
        require(np.all(np.isfinite(self.values)), name, self.values, "finite values")
        most = self.values[np.argmax(np.abs(self.values))]
        require(abs(most) <= _LARGEST, name, most, f"values up to {_LARGEST:.0e}")
        self.uncertainty = None
        if uncertainty is not None:
            self.uncertainty = _deviations(uncertainty, self.ts.shape)

    @classmethod
    def from_csv(cls, path: Any, decimal: str | None = None) -> "Trace":
        """Read a file with a line of names, `t`, one of `force` and `z`, and, where it is
        known, `uncertainty`, in s, N and m or in the units that the names carry: `t (ms)`,
        `force [mN]`, `z/um`, or comments: `# force in mN`. A column `index` is skipped.
        `decimal`: the mark of decimals, "." or ",", where the file can be read both ways.

        UTF-8 or UTF-16; separated by commas, semicolons, tabs or blanks; decimal commas
        where columns are not separated by them; lines that begin with # are comments.

        Raises `ValueError`, one line that names file, line and column, for what is no such
        table.

        >>> ts = np.linspace(0.0, 3.0, 301)
        >>> fx.Trace(ts, force=0.1 * np.sin(ts)).to_csv("loop.csv")
        >>> fx.Trace.from_csv("loop.csv")
        Trace(force: 301 times in [0, 3] s)
        """
        try:
            columns = trace_columns(Path(path), decimal)
            times, uncertainty = columns.pop("t"), columns.pop("uncertainty", None)
            measured: Any = columns
            return cls(times, **measured, uncertainty=uncertainty)
        except OSError as error:
            raise ValueError(f"{path}: {error.strerror or error}") from None
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from None

    def to_csv(self, path: Any) -> None:
        """Write the file that `from_csv` reads."""
        columns = {"t": self.ts, self.quantity: self.values}
        if self.uncertainty is not None:
            columns["uncertainty"] = self.uncertainty
        text = io.StringIO(newline="")
        rows = csv.writer(text)
        rows.writerow(columns)
        rows.writerows(zip(*(v.tolist() for v in columns.values()), strict=True))
        write_whole(path, text.getvalue())

    def __repr__(self) -> str:
        times = f"{self.ts.size} times in [{as_text(self.ts[0])}, {as_text(self.ts[-1])}] s"
        left = f", {self.masked} masked samples left out" if self.masked else ""
        return f"Trace({self.quantity}: {times}{left})"


def _deviations(uncertainty: Any, shape: tuple) -> np.ndarray:
    name = "trace.uncertainty"
    known = numbers_of(name, uncertainty)
    allowed = f"one number or the shape {shape} of ts"
    require(known.ndim == 0 or known.shape == shape, name, known.shape, allowed)
    good = np.all(np.isfinite(known)) and np.all(known > 0)
    require(good, name, known, "uncertainties > 0")
    most = np.max(known)
    require(most <= _LARGEST, name, most, f"uncertainties up to {_LARGEST:.0e}")
    return np.broadcast_to(known, shape).copy()


@with_nan
def simulate_trace(
    scene: Scene,
    eps: Any,
    gamma: Any = 1.0,
    ts: Any = None,
    quantity: str = "force",
    noise: Any = 0.0,
    seed: int = 0,
    accuracy: Any = 1e-4,
) -> Trace:
    """The trace that a scene would give: `solve`, with normal noise added.

    `scene`, `eps` (m), `gamma`: as in `solve`. `quantity`: "force" or "z". `ts`: 301 evenly
    spaced times where None. `noise`: standard deviation in N or m; it becomes the trace's
    `uncertainty` where it is not 0; `seed`: of it. `accuracy`: as in `solve`.

    Returns a `Trace`.

    Raises `ValueError` as `solve`, for an unknown quantity, and a trajectory that failed.

    >>> trace = fx.simulate_trace(scene, eps=0.1, noise=0.002, accuracy=1e-3)
    >>> trace
    Trace(force: 301 times in [0, 3] s)
    >>> print(f"{trace.values.min():.2f} to {trace.values.max():.2f} N")
    -0.25 to 0.24 N
    """
    require(quantity in TRACE_QUANTITIES, "quantity", quantity, "one of force, z")
    require_whole("seed", seed, 0)
    require_real("noise", noise, "noise >= 0", lambda v: v >= 0)
    scene = scene_for(Engine.TRACE, scene)
    ts = np.asarray(require_times(scene, ts, 301))
    found = solve(scene, eps, gamma, ts, accuracy, dissipation=False)
    require(found.ok, "scene", found.status.message, "a trajectory that can be trusted")
    values = np.asarray(found.z) if quantity == "z" else found.force
    random = np.random.default_rng(seed).normal(size=ts.size)
    measured: Any = {quantity: values + float(noise) * random}
    return Trace(ts, **measured, uncertainty=float(noise) or None)
