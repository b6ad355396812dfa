"""Friction of a tip at a temperature, dragged by a spring at constant speed."""

from typing import Any, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Float

from .._checks import (
    CodedResult,
    Outcome,
    as_text,
    kind_of,
    require,
    require_numbers,
    require_real,
    require_x64,
    with_nan,
)
from .._compile import crew
from ..model import AbstractPotential
from ..supports import Spring
from .driven_period import Drive
from .fixed_point import (
    PeriodicDensity,
    Window,
    on_finer_cells,
    periodic_density,
    with_room,
)
from .potential_samples import sampled_potential
from .settings import SETTINGS


class SmoluchowskiStatus(Outcome):
    """Why a mean friction force can or cannot be trusted; `message` says it for people."""

    OK = 0, "every number can be trusted"
    ROUGH_GRID = 1, "the error that two grids show is larger than the accuracy"
    NOT_PERIODIC = 2, "the density had not become periodic: too fast for so soft a spring"
    LOST_MASS = 3, "probability left the window, or was lost to rounding: too slow"
    TOO_MANY_CELLS = 4, "wells are too many, cold or fast for the cells that there may be"
    NOT_FINITE = 5, "not finite"


class SmoluchowskiFriction(CodedResult, eqx.Module):
    """Mean forces in N of steady slides with noise, arrays of the shape of `speeds`.

    `mean_force`: mean over time and noise of `l - Phi'(z) = k (v t - z)`; `drag`:
    `viscosity v`; `friction_force`: their difference, the mean of V_eps'. `error`: of both,
    estimated from two grids, the finer of which has twice the cells and steps. `codes`: a
    `SmoluchowskiStatus` each, as integers.
    """

    speeds: Float[np.ndarray, "*speeds"]
    mean_force: Float[np.ndarray, "*speeds"]
    drag: Float[np.ndarray, "*speeds"]
    friction_force: Float[np.ndarray, "*speeds"]
    error: Float[np.ndarray, "*speeds"]
    codes: np.ndarray
    _outcomes = SmoluchowskiStatus

    @property
    def _codes(self) -> Any:
        return self.codes

    def _in_words(self) -> str:
        names = ("speeds", "friction_force", "error")
        known = ", ".join(f"{name}={as_text(getattr(self, name))}" for name in names)
        return f"SmoluchowskiFriction({known}, status={self._ended})"


class _Slide(NamedTuple):
    """Mean force and its error in N, and how it ended."""

    mean_force: float
    error: float
    status: SmoluchowskiStatus


class _Wells(NamedTuple):
    """The wells as a drive to the right meets them: largest and smallest `V_eps'` in N."""

    potential: AbstractPotential
    eps: float
    direction: int
    highest: float
    lowest: float

    def rises(self, count: int) -> np.ndarray:
        """Differences of `V_eps` from each of `count` cells of a period to the next, J."""
        places = self.direction * np.arange(count) / count
        energy, _ = sampled_potential(self.potential, self.eps, places)
        return np.roll(energy, -1) - energy


def _wells(potential: AbstractPotential, eps: float, direction: int) -> _Wells:
    count = max(1024, potential.points)
    _, force = sampled_potential(potential, eps, np.arange(count) / count)
    force = direction * force
    return _Wells(potential, eps, direction, float(force.max()), float(force.min()))


@with_nan
def smoluchowski_friction(
    potential: AbstractPotential,
    support: Spring,
    speeds: Any,
    *,
    eps: float,
    viscosity: float,
    temperature: Any,
    accuracy: float = SETTINGS.accuracy,
) -> SmoluchowskiFriction:
    """Mean friction of steady slides with noise, by Smoluchowski's equation.

    The far end of the spring moves at constant speed, `l = k v t`: the density of z that
    repeats from well to well is computed, nothing is sampled. `support`: a `Spring`, k in
    N/m; `speeds`: v in m/s, any shape, negative to the left; `viscosity` (eps^gamma) in
    N s/m, `temperature` (T_eps) in J, any shape that goes with that of `speeds`, as NumPy
    has it; eps in m; `accuracy`: wanted error of forces, of the largest |V_eps'|. At speed
    0 all forces are 0, as at small speeds.

    Grids are refined until two of them agree, and values are extrapolated from these two,
    whose errors fall fourfold; `error` is what is left of the finer one's. Slides go one
    after the other, two at once: rows of a compiled call would wait for their slowest.

    Raises `ValueError` for numbers out of range, and supports that are no spring: with
    others there is no steady slide.
    """
    require_x64(potential, support)
    springs = "a Spring: with others there is no steady slide"
    require(isinstance(support, Spring), "support", kind_of(support), springs)
    require_numbers("speeds", speeds, "finite numbers in m/s", lambda v: np.isfinite(v))
    require_real("eps", eps, "eps > 0 in m", lambda v: v > 0)
    require_real("viscosity", viscosity, "viscosity > 0 in N s/m", lambda v: v > 0)
    warm = "temperatures > 0 in J"
    require_numbers("temperature", temperature, warm, lambda v: (v > 0) & np.isfinite(v))
    require_real("accuracy", accuracy, "accuracy > 0", lambda v: v > 0)
    asked, baths = np.broadcast_arrays(
        np.asarray(speeds, dtype=float), np.asarray(temperature, dtype=float)
    )
    stiffness = float(support.stiffness)
    wells = {s: _wells(potential, float(eps), s) for s in np.unique(np.sign(asked)) if s}

    def slide(speed: float, bath: float) -> _Slide:
        if speed == 0:
            return _Slide(0.0, 0.0, SmoluchowskiStatus.OK)
        numbers = eps, stiffness, viscosity, bath, abs(speed)
        sign = np.sign(speed)
        found = _slide(wells[sign], Drive(*(float(n) for n in numbers)), accuracy)
        return found._replace(mean_force=sign * found.mean_force)

    cells = asked.ravel().tolist(), baths.ravel().tolist()
    found = list(crew("densities").map(slide, *cells))
    mean_force, error = (
        np.reshape([getattr(s, name) for s in found], asked.shape)
        for name in ("mean_force", "error")
    )
    drag = float(viscosity) * asked
    codes = np.reshape([int(s.status) for s in found], asked.shape)
    return SmoluchowskiFriction(asked, mean_force, drag, mean_force - drag, error, codes)


class _March:
    """Densities of one slide, for as long as there is work left for it."""

    def __init__(self, wells: _Wells, drive: Drive) -> None:
        self._wells, self._drive = wells, drive
        self._left = SETTINGS.most_marched  # cells times steps

    def periodic(
        self, window: Window, guess: np.ndarray, steps: int, share: float
    ) -> PeriodicDensity:
        """By a `share` of what is left at most, but by one period always."""
        rises = self._wells.rises(guess.size // window.periods)
        rounds = max(1, int(share * self._left) // (guess.size * steps))
        found = periodic_density(rises, steps, self._drive, window, guess, rounds)
        self._left -= found.rounds * guess.size * steps
        return found

    def allows(self, work: int, coarse: PeriodicDensity | None) -> bool:
        """Whether a grid of so much `work` a period may come to its end: that of one that
        sets off from a coarser grid's density is half as many periods away at best."""
        fewest = 0.0 if coarse is None else 0.5 * coarse.rounds
        return work <= SETTINGS.most_work and fewest * work <= self._left


def _slide(wells: _Wells, drive: Drive, accuracy: float) -> _Slide:
    """To the right, on grids that are refined until two of them agree."""
    result = _Slide(np.nan, np.nan, SmoluchowskiStatus.TOO_MANY_CELLS)
    march = _March(wells, drive)
    start = _start(wells, drive, march)
    if start is None:
        return result
    window, guess = start
    coarse, steps = None, SETTINGS.steps
    wanted = accuracy * max(wells.highest, -wells.lowest)
    for _ in range(SETTINGS.grids):
        if not march.allows(guess.size * steps, coarse):
            break
        share = SETTINGS.share_of_one if coarse is None else 1.0
        fine = march.periodic(window, guess, steps, share)
        if coarse is not None and _is_cut_short(fine):
            break
        if not _is_good(fine):
            return _Slide(fine.mean_force, np.nan, _trouble(fine))
        result = _compared(coarse, fine, wanted)
        if result.status == SmoluchowskiStatus.OK:
            break
        coarse, steps = fine, 2 * steps
        window, guess = on_finer_cells(fine, 2)
    return result


def _compared(
    coarse: PeriodicDensity | None, fine: PeriodicDensity, wanted: float
) -> _Slide:
    """Extrapolated from two grids whose errors differ fourfold."""
    if coarse is None:
        return _Slide(fine.mean_force, np.nan, SmoluchowskiStatus.ROUGH_GRID)
    correction = (fine.mean_force - coarse.mean_force) / 3
    agree = abs(correction) <= wanted
    status = SmoluchowskiStatus.OK if agree else SmoluchowskiStatus.ROUGH_GRID
    return _Slide(fine.mean_force + correction, abs(correction), status)


def _start(wells: _Wells, drive: Drive, march: _March) -> tuple[Window, np.ndarray] | None:
    """Window and guess for the first grid. Where that has many cells, a rougher one tells
    which of the periods have mass: of a cold slide in a soft spring, few. None where not
    even those few may be marched.
    """
    window, count = _window(wells, drive), _coarsest_cells(wells, drive)
    if window is None:
        return None
    rough = max(SETTINGS.least_cells, count // SETTINGS.rougher)
    fewest = count * with_room(0, 0).periods
    # Asked before there are cells: they would not go into memory.
    if SETTINGS.steps * max(rough * window.periods, fewest) > SETTINGS.most_work:
        return None
    guess = _first_guess(wells, drive, window, rough)
    if count == rough:
        return window, guess
    located = march.periodic(window, guess, SETTINGS.steps, SETTINGS.share_of_one)
    return on_finer_cells(located, count // rough)


def _is_good(found: PeriodicDensity) -> bool:
    return found.change <= SETTINGS.periodic and found.lost <= SETTINGS.lost


def _is_cut_short(found: PeriodicDensity) -> bool:
    """By the work that was left for it, not by what it is."""
    known = np.isfinite(found.mean_force + found.change) and found.lost <= SETTINGS.lost
    few = found.rounds < SETTINGS.most_periods
    return bool(known) and few and found.change > SETTINGS.periodic


def _trouble(found: PeriodicDensity) -> SmoluchowskiStatus:
    if not np.isfinite(found.mean_force + found.change + found.lost):
        return SmoluchowskiStatus.NOT_FINITE
    lost = found.lost > SETTINGS.lost
    return SmoluchowskiStatus.LOST_MASS if lost else SmoluchowskiStatus.NOT_PERIODIC


def _coarsest_cells(wells: _Wells, drive: Drive) -> int:
    """Of a period: so many that a well's density has a standard deviation of a few, and
    that drag in a cell is not far above temperature. A power of two: few programs.
    """
    _, force = sampled_potential(wells.potential, wells.eps, np.arange(1024) / 1024)
    curvature = 1024 / wells.eps * float(np.max(np.abs(np.diff(force)))) + drive.stiffness
    deviation = np.sqrt(drive.temperature / curvature)
    with np.errstate(divide="ignore"):  # as cold as floats have it
        count = SETTINGS.cells_a_deviation * wells.eps / deviation
    drag = drive.viscosity * drive.speed
    carried = drag * drive.eps / (SETTINGS.most_carried * drive.temperature)
    count = min(max(count, carried, SETTINGS.least_cells), 1e9)
    return 1 << (int(np.ceil(count)) - 1).bit_length()


def _window(wells: _Wells, drive: Drive) -> Window | None:
    """Periods of z between which the density lives while the support goes from 0 to eps;
    None where floats do not hold them.

    Without noise the force `k (v t - z)` ends between `drag + min V'` and `drag + max V'`,
    and a slip, which descends in energy at a fixed load, ends 3/2 periods beyond the
    support at most. Noise adds the tail of a Gaussian in the spring.
    """
    drag = drive.viscosity * drive.speed
    tail = np.sqrt(-2 * np.log(SETTINGS.tail) * drive.temperature / drive.stiffness)
    behind = (drag + wells.highest) / drive.stiffness + tail
    ahead = min(1.5 * drive.eps, -(drag + wells.lowest) / drive.stiffness) + tail
    with np.errstate(over="ignore"):
        first, end = np.floor(-behind / drive.eps), np.ceil(ahead / drive.eps) + 1
    if not np.isfinite(end - first):
        return None
    return with_room(int(first), int(end))


def _first_guess(wells: _Wells, drive: Drive, window: Window, count: int) -> np.ndarray:
    """A Gaussian, a period wide, where a slide's mean force may be."""
    drag = drive.viscosity * drive.speed
    force = np.hypot(drag, 0.7 * wells.highest)
    places = window.first + np.arange(count * window.periods) / count
    return np.exp(-0.5 * (places + force / (drive.stiffness * drive.eps)) ** 2)
