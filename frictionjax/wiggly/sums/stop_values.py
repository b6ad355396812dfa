"""What lanes found at all stops of a layout: states, energies, integrals on the way."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from ..._checks import Real
from ..._compile import Program, in_chunks
from ...loads import AbstractPull
from ...model import AbstractPotential
from ...supports import AbstractSupport
from ..enclosure import BracketContext, BracketValues, Layout, SampledPeriods
from ..limit_path import SURPLUS, WORK, SampledSlide, sampled_slides_of
from .settings import SETTINGS


@Program
def _energies(
    potential: AbstractPotential,
    support: AbstractSupport,
    load: AbstractPull,
    eps,
    well,
    tip,
    t,
    guide,
):
    """z in m at stops, E_eps of z less E of the guide, and the size of its parts, in J."""

    def one(eps: Real, well: Real, tip: Real, t: Real, guide: Real):
        z = eps * (well + tip) + potential.offset(tip, eps)
        wiggle = potential.tip_energy_change(tip, eps)
        held, at_guide = support.energy(z), support.energy(guide)
        pull = load(t) * (z - guide)
        size = jnp.abs(held) + jnp.abs(at_guide) + jnp.abs(pull) + jnp.abs(wiggle)
        return z, held - at_guide - pull + wiggle, size

    return jax.vmap(one)(eps, well, tip, t, guide)


class StopValues(NamedTuple):
    """What the sums need of every stop, shape (S,); `sums` (3, S), `extremes` (5, S).

    `size`: of the energies whose differences `energy` is, J.
    """

    time: np.ndarray
    z: np.ndarray
    energy: np.ndarray
    size: np.ndarray
    sums: np.ndarray
    beyond: np.ndarray
    extremes: np.ndarray


def stop_values_of(
    rounds: BracketContext, layout: Layout, values: BracketValues
) -> tuple[StopValues, np.ndarray, np.ndarray]:
    """What was found at every stop of a layout; state and energy where cells start."""
    scene, ground = rounds.scene, rounds.ground
    brackets, a, segments = layout.brackets, values.arrivals, values.segments
    count = ground.eps.size
    columns = (
        np.append(ground.eps, ground.eps[brackets.cell[brackets.owner]]),
        np.append(ground.start_well, a.well),
        np.append(ground.start_tip, a.tip),
        np.append(np.zeros(count), brackets.stop),
        np.append(np.full(count, rounds.path.states[0]), segments.guide1),
    )
    parts = scene.potential, scene.support, scene.load
    z, energy, size = in_chunks(_energies, SETTINGS.stops, parts, columns)
    rise = segments.guide1 - segments.guide0
    moved = segments.end > segments.start
    ways, surpluses = (a.ahead, a.behind, a.outside), (a.surplus, a.deficit)
    stops = StopValues(
        time=brackets.stop,
        z=z[count:],
        energy=energy[count:],
        size=size[count:],
        sums=np.stack([a.work, a.viscous, a.residual]),
        beyond=a.viscous - segments.friction * rise,
        extremes=np.stack([*(np.where(moved, v, 0.0) for v in ways), *surpluses]),
    )
    return stops, z[:count], energy[:count]


def sampled_slides_at(
    slides: list[SampledPeriods], stops: StopValues
) -> dict[int, SampledSlide]:
    """Curves through the periods measured in each slide, by the number of the slide."""
    found: dict[int, SampledSlide] = {}
    counts = np.array([slide.stops.size for slide in slides])
    for count in np.unique(counts):
        mine = np.flatnonzero(counts == count)
        alike = [slides[i] for i in mine]
        at = np.stack([slide.stops for slide in alike])
        sums = stops.sums[:, at].swapaxes(0, 1)
        extremes = stops.extremes[:, at].swapaxes(0, 1)
        start = stops.energy[at] + sums[:, WORK] + stops.beyond[at]
        extremes[:, SURPLUS:] -= start[:, None]
        low, high = np.array([(slide.low, slide.high) for slide in alike]).T
        starts = np.stack([slide.starts for slide in alike])
        ends = np.stack([slide.ends for slide in alike])
        fits = sampled_slides_of(low, high, starts, ends, sums, extremes)
        found |= zip(mine.tolist(), fits, strict=True)
    return found
