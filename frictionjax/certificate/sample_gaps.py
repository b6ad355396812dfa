"""The gaps between the samples of a curve with mass."""

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

_Column = Float[np.ndarray, " k"]


class SampleGaps(NamedTuple):
    """Columns of gaps, (k,): start and length in s, the well, at the start the tip from it
    in periods and `u = z'/eps` in 1/s, what both rise by, and y' at both ends in 1/s.

    `unit`: of speeds u, in 1/s.
    """

    start: _Column
    length: _Column
    well: _Column
    tip: _Column
    speed: _Column
    rise: _Column
    faster: _Column
    rate0: _Column
    rate1: _Column
    unit: float

    @classmethod
    def between(cls, ts, well, inside, speed, rate, unit: float) -> "SampleGaps":
        """Of samples: the tip at well + inside, u, and y', (k + 1,)."""
        return cls(
            start=ts[:-1],
            length=np.diff(ts),
            well=well[:-1],
            tip=inside[:-1],
            speed=speed[:-1],
            rise=np.diff(well) + np.diff(inside),
            faster=np.diff(speed),
            rate0=rate[:-1],
            rate1=rate[1:],
            unit=unit,
        )

    def at(self, rows: Any) -> "SampleGaps":
        """Some of them, in columns of the shape of `rows`."""
        return SampleGaps(*(column[rows] for column in self[:-1]), unit=self.unit)

    @property
    def ends(self) -> tuple[Float[np.ndarray, "k 2"], Float[np.ndarray, "k 2"]]:
        """Tip and speed at both, from the well of the start, speeds in units."""
        first = np.stack([self.tip, self.speed / self.unit], axis=1)
        return first, first + np.stack([self.rise, self.faster / self.unit], axis=1)
