"""How long a tip that slides without rest takes from one well to the next.

In a fast slide the force never falls to zero, so time is a function of the tip: from
eq. 2.7, `dt/dy = eps^(gamma+1) G/(l - Phi' - V_eps')`, over exactly one period. That
integrand is smooth and hardly stiff, where `y'` as a function of time is both.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..arguments import Real
from ..potentials import AbstractPotential
from ..programs import Program, in_chunks, room
from ..scene import Scene
from ..strip import CHUNK

_POINTS = 10  # Gauss nodes of a panel
_X, _W = np.polynomial.legendre.leggauss(_POINTS)
_LEGENDRE = np.polynomial.legendre.legvander(_X, _POINTS - 1)
_TO_SERIES = np.linalg.inv(_LEGENDRE)
_DEPTH = 26  # halvings of the period: folds narrower than 1e-8 of it are not resolved
_ROUGH = 1e-6  # of the whole integral: last coefficients of a panel that is split
# Sweeps of Newton's method from a guess that keeps the force constant, and from the
# times of a passage nearby.
_SWEEPS, _AGAIN = 5, 1
_NEAR = 256  # Taylor series of one compiled call
TOGETHER = 12  # passages of a track side by side


def _integrals() -> np.ndarray:
    """Matrix from values at Gauss nodes to integrals from the left end to each node."""
    columns = []
    for k in range(_POINTS):
        primitive = np.polynomial.legendre.legint(np.eye(_POINTS)[k], lbnd=-1)
        columns.append(np.polynomial.legendre.legval(_X, primitive))
    return np.stack(columns, axis=1) @ _TO_SERIES


_TO_NODES = _integrals()


class Track(NamedTuple):
    """The wiggly force along one period, as a fast tip meets it; C cells, M nodes.

    Counted in the direction of motion, from a lattice point: at the extreme fold, where
    the tip is slowest. `way` (C, M): z in m since that point. `against` (C, M): V_eps'
    in N, its sign turned for slides to the left. `weight` (C, M): `eps G` times half the
    width of the node's panel, in m. `sign` (C,): 1 or -1.
    """

    way: np.ndarray
    against: np.ndarray
    weight: np.ndarray
    sign: np.ndarray


class Pull(NamedTuple):
    """Force on the flat surface near the lattice point, as Taylor series; shape (...,).

    `load`: of l in time, `support`: of Phi' in z, four derivatives each on the last axis.
    """

    load: np.ndarray
    support: np.ndarray


class Passage(NamedTuple):
    """Passages over one well: `length` in s, `kept`, and `times` at the nodes (..., M).

    `kept`: the share of a shift in time at the start that is left at the end. All NaN
    where the force vanishes on the way.
    """

    length: np.ndarray
    kept: np.ndarray
    times: np.ndarray


@Program
def _wiggles(potential: AbstractPotential, eps, places):
    def one(eps: Real, y: Real):
        return *potential.tip_force(y, eps), potential.offset(y, eps)

    return jax.vmap(one)(eps, places)


def wiggles_at(potential: AbstractPotential, eps: np.ndarray, places: np.ndarray):
    """`V_eps'` in N, G, and A in m at tip coordinates, all of one shape."""
    columns = np.broadcast_to(eps, places.shape).ravel(), places.ravel()
    found = in_chunks(_wiggles, CHUNK, (potential,), columns)
    return [v.reshape(places.shape) for v in found]


class Stretch(NamedTuple):
    """Parts of a period to be resolved, shape (C,).

    From the tip coordinate `start` on, `length` periods in the direction `sign`. `fold`:
    V_eps' in N at the extreme fold on that side. `excess`: force in N by which the pull is
    larger, at least: it says how narrow the passage of a fold is.
    """

    eps: np.ndarray
    start: np.ndarray
    length: np.ndarray
    sign: np.ndarray
    fold: np.ndarray
    excess: np.ndarray

    def places(self, cell: np.ndarray, left: np.ndarray, width: np.ndarray) -> np.ndarray:
        """Tip coordinates of the Gauss nodes of panels given as shares of the way."""
        inside = left[:, None] + width[:, None] * 0.5 * (_X + 1)
        way = self.sign[cell] * self.length[cell]
        return self.start[cell][:, None] + way[:, None] * inside


def _roughness(potential, some: Stretch, cell, left, width) -> tuple[np.ndarray, ...]:
    """What each panel adds to the integral of 1/force, and its last coefficients."""
    places = some.places(cell, left, width)
    force, stretch, _ = wiggles_at(potential, some.eps[cell][:, None], places)
    gaps = (some.sign * some.fold)[cell][:, None] - some.sign[cell][:, None] * force
    values = stretch / (some.excess[cell][:, None] + np.maximum(gaps, 0.0))
    series = np.abs(values @ _TO_SERIES.T)
    rough = 0.5 * width * (series[:, -1] + series[:, -2])
    return 0.5 * width * (values @ _W), rough


def _graded(potential, some: Stretch) -> tuple[np.ndarray, ...]:
    """Panels of every cell, graded towards its folds: cell, left end, width, sorted."""
    count = some.eps.size
    cell = np.repeat(np.arange(count), 4)
    left, width = np.tile(np.arange(4) / 4, count), np.full(4 * count, 0.25)
    whole = np.zeros(count)
    done: list[tuple[np.ndarray, ...]] = []
    for level in range(_DEPTH):
        part, rough = _roughness(potential, some, cell, left, width)
        if level == 0:
            np.add.at(whole, cell, part)
        split = (rough > _ROUGH * whole[cell]) & (level < _DEPTH - 1)
        done.append((cell[~split], left[~split], width[~split]))
        if not split.any():
            break
        half = 0.5 * width[split]
        cell = np.repeat(cell[split], 2)
        left = np.stack([left[split], left[split] + half], axis=1).ravel()
        width = np.repeat(half, 2)
    cell, left, width = (np.concatenate(c) for c in zip(*done, strict=True))
    order = np.lexsort((left, cell))
    return cell[order], left[order], width[order]


def track_of(potential: AbstractPotential, some: Stretch) -> Track:
    """The force along stretches of a period, resolved for the excess.

    Panels are halved until the last Legendre coefficients of 1/force are below 1e-6 of
    the whole integral; cells with fewer panels get empty ones.
    """
    cell, left, width = _graded(potential, some)
    count = np.bincount(cell, minlength=some.eps.size)
    most = room(int(count.max()), 32, 2)
    place = np.arange(cell.size) - np.repeat(np.cumsum(count) - count, count)
    lefts, widths = np.ones((some.eps.size, most)), np.zeros((some.eps.size, most))
    lefts[cell, place], widths[cell, place] = left, width
    whose = np.repeat(np.arange(some.eps.size), most)
    places = some.places(whose, lefts.ravel(), widths.ravel())
    places = places.reshape(some.eps.size, -1)
    eps = some.eps[:, None]
    force, stretch, offset = wiggles_at(potential, eps, places)
    origin = wiggles_at(potential, some.eps, some.start)[2]
    half = np.repeat(0.5 * widths * some.length[:, None], _POINTS, axis=1)
    return Track(
        way=eps * (places - some.start[:, None]) + offset - origin[:, None],
        against=some.sign[:, None] * force,
        weight=eps * stretch * half,
        sign=some.sign,
    )


@jax.jit
def _passages(way, against, weight, sign, load, support, viscosity, times, sweeps):
    """Newton's method for `t(y)`, linearised exactly: quadratic, and fit for stiff ends."""
    shape = (*times.shape[:-1], -1, _POINTS)
    to_nodes, weights = jnp.asarray(_TO_NODES.T), jnp.asarray(_W)

    def running(values):
        """Integrals from the start to each node, and to the end."""
        panels = values.reshape(shape)
        each = panels @ weights
        before = jnp.cumsum(each, axis=-1) - each
        found = panels @ to_nodes + before[..., None]
        return found.reshape(times.shape), jnp.sum(each, axis=-1)

    side = sign[:, None, None]
    s = [support[..., k, None] for k in range(4)]
    f = [side * load[..., k, None] for k in range(4)]
    z = way[:, None, :]
    held = side * (s[0] + z * (s[1] + z * (s[2] / 2 + z * s[3] / 6))) + against[:, None, :]
    pace = viscosity[:, None, None] * weight[:, None, :]

    def slopes(t):
        force = f[0] + t * (f[1] + t * (f[2] / 2 + t * f[3] / 6)) - held
        gain = f[1] + t * (f[2] + t * f[3] / 2)
        rate = pace / force
        return force, rate, -rate * gain / force

    def sweep(_, t):
        _, rate, bend = slopes(t)
        grown, _ = running(bend)
        # (t + d)' = rate + bend d; e = exp(grown) solves the homogeneous equation.
        found, _ = running((rate - bend * t) * jnp.exp(-grown))
        return found * jnp.exp(grown)

    times = jax.lax.fori_loop(0, sweeps, sweep, times)
    force, rate, bend = slopes(times)
    _, length = running(rate)
    _, grown = running(bend)
    smallest = jnp.min(jnp.where(pace > 0, force, jnp.inf), axis=-1)
    blank = jnp.where(smallest > 0, 0.0, jnp.nan)
    return length + blank, jnp.exp(grown) + blank, times


def passages(track: Track, pull: Pull, viscosity: np.ndarray, times=None) -> Passage:
    """Passages of one well from n lattice points of each cell; `pull` has shape (C, n).

    `times` (C, n, M): a guess; None where the pull stays the same. `viscosity` (C,):
    eps^gamma.
    """
    sweeps = _AGAIN if times is not None else _SWEEPS
    if times is None:
        rate = pull.load[..., 1]  # where it is 0, nothing passes
        steady = pull.support[..., 1] / np.where(rate == 0, np.nan, rate)
        times = track.way[:, None, :] * steady[..., None]
    found = _passages(*track, pull.load, pull.support, viscosity, times, sweeps)
    return Passage(*(np.asarray(v) for v in found))


def one_passage(track: Track, pull: Pull, viscosity: np.ndarray) -> np.ndarray:
    """Seconds of one passage of each track, shape (C,); `pull` has that shape too."""
    # As many as `passages` is asked for elsewhere: no further program is compiled.
    many = Pull(*(np.repeat(series[:, None], TOGETHER, axis=1) for series in pull))
    return passages(track, many, viscosity).length[:, 0]


@Program
def _series(scene: Scene, times: Float[Array, " n"], states: Float[Array, " n"]):
    def derivatives(fn):
        first = jax.grad(fn)
        second = jax.grad(first)
        third = jax.grad(second)
        return lambda x: jnp.stack([fn(x), first(x), second(x), third(x)])

    load = jax.vmap(derivatives(scene.load))(times)
    support = jax.vmap(derivatives(scene.support.force))(states)
    return load, support


def pull_at(scene: Scene, times: np.ndarray, states: np.ndarray) -> Pull:
    """Taylor series of l and Phi' at times in s and states in m of one shape."""
    columns = times.ravel(), states.ravel()
    found = in_chunks(_series, _NEAR, (scene,), columns)
    return Pull(*(v.reshape(*times.shape, 4) for v in found))
