"""What a trajectory of the wiggly system is told as."""

from typing import TYPE_CHECKING, Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float, Int

from .._checks import CodedResult, require
from .._text import Named, SelfDrawn, ShownNumbers, dataset_over_time
from .equation import Status
from .how_obtained import how_in_words
from .solved_scene import loads_and_forces, require_one_force

if TYPE_CHECKING:
    import xarray as xr

_COLUMNS = {
    "z": ("m", "state of the wiggly system"),
    "dissipation": ("J", "energy dissipated since t = 0, int eps^gamma z'^2"),
    "residual": ("J", "residual of the energy-dissipation balance"),
    "velocity": ("m s-1", "velocity z'"),
    "root": ("m", "root u of the rod"),
    "tip": ("m", "tip p of the rod"),
    "mode": ("1", "1: the rod as it stands at first; -1: turned over; 0: in between"),
}


class Solution(ShownNumbers, SelfDrawn, CodedResult, eqx.Module):
    """Trajectory of the wiggly system.

    `ts` in s, `z` in m, shapes (n,). `dissipation`: `int_0^ts eps^gamma z'^2` in J.
    `residual`: `int_0^ts (eps^gamma z' + D E)^2/(2 eps^gamma)` in J, of the
    energy-dissipation balance; both are None where dissipation was not asked for. `ok`:
    every number can be trusted. `stats`: steps, rejected steps, tolerance in periods, how
    values were obtained, and `dissipation_gap`, the distance in J at the end between the
    dissipation and an independent second value of it. From lanes also `how` (n,): 0 where
    every slip since z0 is integrated, 1 where a bracket from below and above has closed, 2
    where one has that set off from a slip map, as wide as the map's measured error;
    `bracket` (n,): how closely, in eps; `sampled`: share of the way that is known from some
    of its slips, NaN where only values at `ts` were wanted. Of a `CompliantArray` values
    are means over its bristles, and `spread` (n,) is their standard deviation in m.
    Of a path with noise `step` is the length of its steps in s.

    With `effects.Inertia` also `velocity` (n,), z' in m/s; else it is None. `residual` is
    then what is left of the balance of energies, kinetic energy among them, `spread` (n,)
    how far in m runs at other tolerances are from it (where they end in different
    wells the status is SENSITIVE), and `beta` the number that decides whether mass matters.

    With `effects.NapFlip` also `root` u and `tip` p in m and `mode` (n,): 1 as the rod
    stands at first, -1 turned over, 0 in between; else they are None.
    """

    ts: Float[Array, " n"]
    z: Float[Array, " n"]
    dissipation: Float[Array, " n"] | None
    residual: Float[Array, " n"] | None
    status_code: Int[Array, ""]
    counts: dict[str, Any]
    words: str = eqx.field(static=True)
    velocity: Float[Array, " n"] | None = None
    root: Float[Array, " n"] | None = None
    mode: Int[Array, " n"] | None = None
    tip: Float[Array, " n"] | None = None
    _outcomes = Status
    _picture = "draw_solution"

    @property
    def how(self) -> str:
        """How values were obtained, in words; of a batch, those of all together.

        Made when it is read: solutions of one scene are trees of one structure.
        """
        return how_in_words(self.words, self.counts)

    @property
    def stats(self) -> dict[str, Any]:
        """Counts, and under "values" how the values were obtained."""
        return {**self.counts, "values": self.how}

    @property
    def _codes(self) -> Any:
        return self.status_code

    @property
    def load(self) -> Float[np.ndarray, " n"]:
        """The load l(t) in N. Raises `ValueError` of a batch, and of a traced solve."""
        return loads_and_forces(self)[0]

    @property
    def force(self) -> Float[np.ndarray, " n"]:
        """`l - Phi'(z)` in N, what friction (and mass) holds against.

        Raises `ValueError` as `load` does, and of compliant arrays and rods that turn over.
        """
        require_one_force(self)
        return loads_and_forces(self)[1]

    def to_dataset(self) -> "xr.Dataset":
        """What there is over the dimension `time` (s), with units and how it ended.

        Raises `ValueError` of a batch.

        >>> data = fx.solve(scene, eps=0.01).to_dataset()
        >>> print(f"{data.z.sel(time=0.75):.3f} {data.z.units}: {data.message}")
        0.930 m: every number can be trusted
        """
        require(np.ndim(self.z) == 1, "solution", "a batch", "one trajectory")
        ended = {"status": self.status.name, "message": self.message, "values": self.how}
        return dataset_over_time(self, _COLUMNS, ended)

    def _in_words(self) -> str:
        ended, steps = self._ended, np.asarray(self.stats["steps"])
        if np.ndim(self.status_code):
            parts = (
                f"{np.shape(self.z)[-1]} times each, up to {np.max(steps, initial=0)} steps"
            )
            return f"Solution(batch {np.shape(self.status_code)}: {ended}; {parts})"
        end = f"z({float(self.ts[-1]):.6g} s) = {float(self.z[-1]):.9g} m"
        return f"Solution({ended}: {self.ts.size} times, {end}, {int(steps)} steps)"

    def _numbers(self) -> list[Named]:
        told = self.counts
        return [
            Named("time", self.ts[..., -1], "s", "the last one"),
            Named("z", self.z[..., -1], "m", "the state then"),
            Named("velocity", _last(self.velocity), "m/s", "z' then"),
            Named("root", _last(self.root), "m", "where the root is then"),
            Named("tip", _last(self.tip), "m", "where the tip is then"),
            Named("mode", _last(self.mode), "", "1 as it stood at first, -1 turned over"),
            Named("dissipation", _last(self.dissipation), "J", "into viscosity until then"),
            Named("residual", _last(self.residual), "J", "of the balance of energies"),
            Named("beta", told.get("beta"), "", "far below 1 mass does not matter"),
            Named("tolerance", told["tolerance"], "periods", "of a step"),
            Named("steps", told["steps"], "", self.how),
            Named("rejected", told["rejected"], "", "of the steps"),
        ]


def _last(values: Array | None) -> Array | None:
    return None if values is None else values[..., -1]
