"""Errors that the laws of a slide predict for the cells of a sweep."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from .averaged_motion import AveragedMotion, averaged_motion, steady_force
from .exponents import AVERAGED, FREE, SLIPS, LimitOrbit, fold_force, limit_orbit
from .ingredients import SlideData
from .orbit import Orbit, periodic_orbit
from .settings import SETTINGS
from .well_force import WellForce, well_force

_PARABOLA = 3  # nodes


class Law(NamedTuple):
    """`error ~ constant eps^order` for eps -> 0, and why; NaN and "free" if not known."""

    order: float
    constant: float
    name: str


NO_LAW = Law(np.nan, np.nan, FREE)


class Prediction(NamedTuple):
    """Of one error: `errors` at all cells (gamma, eps), and a law for each gamma.

    NaN where the limit does not slide over a few wells.
    """

    errors: Float[np.ndarray, "g e"]
    laws: list[Law]


# For eps -> 0 the lag follows the load at once.
_AT_ONCE = AveragedMotion(np.zeros(1), np.zeros((1, 1)))


class _Slide(NamedTuple):
    """Slides in one direction: moments (m,), their speed and stiffness, the wells."""

    well: WellForce
    moments: Int[np.ndarray, " m"]
    speed: Float[np.ndarray, " m"]
    stiffness: Float[np.ndarray, " m"]


class _Errors(NamedTuple):
    """`sup_error`, `strip_excess` (m) and `dissipation_error` (J) of cells (c,)."""

    sup: Float[np.ndarray, " c"]
    strip: Float[np.ndarray, " c"]
    dissipation: Float[np.ndarray, " c"]


def predict_errors(
    data: SlideData, eps: Float[np.ndarray, " e"], gamma: Float[np.ndarray, " g"]
) -> dict[str, Prediction]:
    """What the laws say of cells `gamma` (g,) x `eps` (e,), by name of the error.

    Forces inside wells are those of steady slides; what is slower than a well, the delay of
    the lag behind the load, follows from the averaged equation.
    """
    slides = _slides(data)
    moved = float(np.sum(np.abs(data.speed) * data.length))
    cell_gamma, cell_eps = (v.ravel() for v in np.meshgrid(gamma, eps, indexing="ij"))
    forces = [_forces(one, cell_eps, cell_gamma) for one in slides]
    motion = averaged_motion(data, _wells(data, slides), cell_eps, cell_gamma)
    steady = [
        steady_force(one.well, one.speed * (cell_eps**cell_gamma)[:, None])
        for one in slides
    ]
    found = _errors(data, slides, forces, steady, motion)
    known = moved / cell_eps >= SETTINGS.few_wells
    laws = [_laws(data, slides, float(g)) for g in gamma]
    shape = gamma.size, eps.size
    return {
        name: Prediction(
            np.where(known, values, np.nan).reshape(shape), [row[i] for row in laws]
        )
        for i, (name, values) in enumerate(
            zip(("sup_error", "strip_excess", "dissipation_error"), found, strict=True)
        )
    }


def _slides(data: SlideData) -> list[_Slide]:
    found = []
    for sign in (1, -1):
        moments = np.flatnonzero(sign * data.speed > 0)
        if moments.size:
            well = well_force(data.phase, data.force, data.change, sign)
            speed = np.abs(data.speed[moments])
            found.append(_Slide(well, moments, speed, data.stiffness[moments]))
    return found


def _errors(
    data: SlideData,
    slides: list[_Slide],
    forces: list[Orbit],
    steady: list[np.ndarray],
    motion: AveragedMotion,
) -> _Errors:
    """From forces beyond rho at the moments of each slide, (cells, moments).

    `z_eps - z = (rho - F)/k`. What is dissipated beyond the limit's is that of the averaged
    motion, `int (F - rho) dz` of what whole wells add to it (`steady` is its own force),
    and rho (z_eps - z) of where in a well the tip is.
    """
    cells = motion.delay.size
    state, strip = np.full(cells, np.nan), np.full(cells, np.nan)
    rate, late, early = (np.zeros((cells, data.speed.size)) for _ in range(3))
    for one, force, even in zip(slides, forces, steady, strict=True):
        lag, lead = force.largest / one.stiffness, -force.smallest / one.stiffness
        farthest = np.maximum(lag.max(axis=1) + motion.delay, 0.0)
        state = np.fmax(state, np.maximum(farthest, lead.max(axis=1)))
        strip = np.fmax(strip, farthest)
        rate[:, one.moments] = (force.mean - even) * one.speed
        late[:, one.moments] = one.well.rho * (even / one.stiffness - lag)
        early[:, one.moments] = one.well.rho * (even / one.stiffness + lead)
    spent = motion.spent + np.cumsum(rate * data.length, axis=1)
    found = np.maximum(np.abs(spent + late).max(axis=1), np.abs(spent + early).max(axis=1))
    return _Errors(state, strip, found)


def _forces(slide: _Slide, eps: np.ndarray, gamma: np.ndarray) -> Orbit:
    """Forces beyond rho (N) at the moments of a slide, (cells, moments)."""
    low, high = float(slide.stiffness.min()), float(slide.stiffness.max())
    alike = high <= SETTINGS.alike * low
    stiffness = np.geomspace(low, high, 1 if alike else SETTINGS.stiffnesses)
    speed = slide.speed.max() * np.array(SETTINGS.speeds)
    drop = stiffness[:, None] * eps[:, None, None]
    drag = speed * (eps**gamma)[:, None, None]
    nodes = periodic_orbit(slide.well, drop, drag)
    rows = _weights(np.log(stiffness), np.log(slide.stiffness))
    columns = _weights(speed, slide.speed)
    shift = slide.well.shift * eps[:, None]
    return Orbit._make(_between(values, rows, columns) + shift for values in nodes)


def _weights(nodes: np.ndarray, asked: np.ndarray) -> np.ndarray:
    """Weights of interpolation by parabolas, (nodes, asked), constant beyond the ends.

    (Linear: what is dissipated at gamma below 1/2, where forces are squares of the speed,
    6% too large.)
    """
    if nodes.size < _PARABOLA:
        return np.ones((nodes.size, asked.size))
    inside = np.clip(asked, nodes[0], nodes[-1])
    first = np.clip(np.searchsorted(nodes, inside) - 2, 0, nodes.size - _PARABOLA)
    weights, columns = np.zeros((nodes.size, asked.size)), np.arange(asked.size)
    own = first + np.arange(_PARABOLA)[:, None]
    for one in own:
        others = own[own != one].reshape(_PARABOLA - 1, -1)
        factors = (inside - nodes[others]) / (nodes[one] - nodes[others])
        weights[one, columns] = np.prod(factors, axis=0)
    return weights


def _between(values: np.ndarray, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Of (cells, rows, columns), at as many places as the weights have."""
    return np.einsum("cij,im,jm->cm", values, rows, columns, optimize=True)


def _laws(data: SlideData, slides: list[_Slide], gamma: float) -> tuple[Law, Law, Law]:
    """Of sup error, strip excess and dissipation error, for eps -> 0."""
    if not slides:
        return NO_LAW, NO_LAW, NO_LAW
    limits = [limit_orbit(s.well, s.speed, s.stiffness, gamma) for s in slides]
    order = min(one.order for one in limits)
    leading = [_leading(one, order) for one in limits]
    found = _errors(data, slides, leading, [np.zeros(1)] * len(slides), _AT_ONCE)
    name = next(one.law for one in limits if one.order <= order + SETTINGS.tie)
    sup, strip, spent = (Law(order, float(values[0]), name) for values in found)
    if name == AVERAGED:
        spent = spent._replace(constant=_averaged_dissipation(data, slides, gamma, order))
    return sup, _strip_law(slides, limits, strip, gamma), spent


def _averaged_dissipation(
    data: SlideData, slides: list[_Slide], gamma: float, order: float
) -> float:
    """Its error over eps^order, from an eps that is small enough: where a load turns at a
    kink, part of the lag stays, which is no matter of steady slides.
    """
    fastest = max(float(one.speed.max()) for one in slides)
    drag = SETTINGS.small_drag * min(one.well.range for one in slides)
    eps = np.array([(drag / fastest) ** (1 / gamma)])
    steady = [steady_force(one.well, one.speed * eps[:, None] ** gamma) for one in slides]
    forces = [Orbit(force, force, force) for force in steady]
    motion = averaged_motion(data, _wells(data, slides), eps, np.array([gamma]))
    return float(
        _errors(data, slides, forces, steady, motion).dissipation[0] / eps[0] ** order
    )


def _wells(data: SlideData, slides: list[_Slide]) -> dict[int, WellForce]:
    return {int(np.sign(data.speed[one.moments[0]])): one.well for one in slides}


def _leading(limit: LimitOrbit, order: float) -> Orbit:
    """Of what is of higher order than the other direction nothing is left."""
    share = 1.0 if limit.order <= order + SETTINGS.tie else 0.0
    return Orbit._make(share * values[None, :] for values in limit.force)


def _strip_law(
    slides: list[_Slide], limits: list[LimitOrbit], leading: Law, gamma: float
) -> Law:
    """Where all tips rest, what rho changes by decides, and without that the fold's delay.

    Where rho falls with eps the state is inside the strip in the end: no law.
    """
    if any(one.law != SLIPS for one in limits):
        return leading
    shifts = [float(np.max(s.well.shift / s.stiffness)) for s in slides]
    if max(shifts) > SETTINGS.no_shift:
        return leading
    held = [
        s for s, shift in zip(slides, shifts, strict=True) if shift >= -SETTINGS.no_shift
    ]
    if not held:
        return NO_LAW
    folds = []
    for one in held:
        force, order = fold_force(one.well, one.speed, one.stiffness, gamma)
        folds.append(Law(order, float(np.max(force / one.stiffness)), SLIPS))
    return min(folds, key=lambda law: (law.order, -law.constant))
