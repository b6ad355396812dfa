"""A curve of a rod that turns over: stretches in one mode, and what is where they meet."""

import math
from itertools import pairwise
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from ..effects import NapFlip
from ..model import BristlePotential, Scene, known_turning_points, padded_edges
from ..turning import FlippingRod, SceneParts, bent_force, flipping_rod
from .bent_root import BentForceOnRoot, bent_certificate
from .critical_places import Beside, RodSide
from .plain_curve import certificate_under, together
from .settings import SETTINGS
from .verdicts import Certificate, CertificateStatus, nothing_known

_Column = Float[np.ndarray, " n"]


class TurningSamples(NamedTuple):
    """`ts` in s, `z` in m and `mode`, (n,)."""

    ts: _Column
    z: _Column
    mode: np.ndarray

    def rows(self, rows: slice) -> "TurningSamples":
        """Some of them."""
        return TurningSamples(*(column[rows] for column in self))

    def runs(self) -> list[slice]:
        """Stretches of samples in one mode."""
        edges = [0, *(np.flatnonzero(np.diff(self.mode)) + 1).tolist(), self.mode.size]
        return [slice(*pair) for pair in pairwise(edges)]


class _Change(NamedTuple):
    """Of the mode, between two samples: `time` in s, NaN where no float lies between them,
    and the state `z` in m."""

    time: float
    z: float


class _Pinned(NamedTuple):
    """A tip that stays at well + y of a `side`; `above`: z in m with the root above it."""

    side: int
    well: float
    y: float
    above: float


class _Found(NamedTuple):
    """On a stretch: its certificate, None of a single sample; how far in eps it is from
    where it has to begin and to end; whether it is turned wrongly or it cannot be told."""

    certificate: Certificate | None
    apart: float = 0.0
    wrong: bool = False
    open: bool = False
    change: _Change | None = None
    pinned: _Pinned | None = None


class _Course(NamedTuple):
    law: FlippingRod
    parts: SceneParts
    sides: dict[int, RodSide]
    eps: float
    viscosity: float
    scale: float
    turning_points: _Column
    stops: _Column

    def straight(
        self, some: TurningSamples, begins: _Change | None, later: float | None
    ) -> _Found:
        """A stretch in one mode; `later`: the first time in s at which it is left."""
        side = self.sides[int(some.mode[0])]
        near = side.beside(some.z)
        over = side.overloads(self.viscosity, near, some.ts)
        wrong = bool(np.any(near.past & (over > SETTINGS.turned)))
        unseen = self._between_samples(side, some.ts, near)
        ends, pinned = None, None
        if later is not None:
            last = near.at(slice(-1, None))
            (after,) = side.overloads(self.viscosity, last, np.array([later]))
            wrong |= bool(after < -SETTINGS.turned)
            unseen |= bool(after - over[-1] > SETTINGS.turned)
            pinned = self._pinned(side, last)
            time = _reached(some.ts[-1], later, -over[-1], after - over[-1])
            ends = _Change(time, side.standing_at(pinned.well, pinned.y))
        ts, z = _joined(some, begins, ends)
        found = None
        if ts.size > 1:
            args = self.viscosity, self.scale, ts, side.seen(z), self.stops
            found = certificate_under(side.force, *args)
        return _Found(found, wrong=wrong, open=unseen, change=ends, pinned=pinned)

    def bent(
        self,
        some: TurningSamples,
        begins: _Change,
        pinned: _Pinned,
        later: tuple[float, int] | None,
    ) -> _Found:
        """A stretch in between; `later`: the first time in s in a mode, and which."""
        rod = bent_force(self.law.bent._replace(height=self._height(pinned)))
        force = BentForceOnRoot(
            rod=rod,
            above=jnp.asarray(pinned.above),
            support=self.parts.support,
            load=self.parts.load,
            eps=jnp.asarray(self.eps),
        )
        beyond = np.max(np.abs(some.z - pinned.above)) - float(rod.reach)
        apart, ends = max(float(beyond), 0.0), None
        if later is not None:
            time, mode = later
            across = mode * pinned.side
            there = self.sides[mode].standing_at(across * pinned.well, across * pinned.y)
            ends, short = _left(_joined(some, begins, None), time, there)
            apart = max(apart, short)
        ts, z = _joined(some, begins, ends)
        found = None
        if ts.size > 1:
            found = bent_certificate(force, self.viscosity, self.scale, ts, z)
        return _Found(found, apart / self.eps, change=ends)

    def _between_samples(self, side: RodSide, ts: _Column, near: Beside) -> bool:
        """Whether the load turns back past what turns the rod, and no sample tells."""
        turns = self.turning_points
        turns = turns[(turns > ts[0]) & (turns < ts[-1])]
        before = near.at(np.searchsorted(ts, turns) - 1)
        over = side.overloads(self.viscosity, before, turns)
        return bool(np.any(over > SETTINGS.turned))

    def _pinned(self, side: RodSide, last: Beside) -> _Pinned:
        well, y = float(last.well[0]), float(side.places.place[last.which[0]])
        tip = side.side * self.eps * (well + y)
        return _Pinned(side.side, well, y, tip - self.law.reach)

    def _height(self, pinned: _Pinned) -> Any:
        """Of the root above its tip, in m."""
        low = self.sides[pinned.side].surface_at(pinned.y)
        return np.asarray(float(self.law.bent.height) - low)


def turning_certificate(
    scene: Scene,
    effect: NapFlip,
    *,
    eps: float,
    viscosity: float,
    scale: float,
    ts: _Column,
    z: _Column,
    root: _Column,
    mode: np.ndarray,
) -> Certificate:
    """Of finite samples; `viscosity` is `eps^gamma`, `scale` the energy of a slip in J."""
    course = _course(scene, effect, eps, viscosity, scale)
    samples = TurningSamples(ts, z, mode)
    found = _stretches(course, samples)
    certificates = [one.certificate for one in found if one.certificate is not None]
    if not certificates:
        return nothing_known(scale)._replace(status=CertificateStatus.UNRESOLVED)
    all_in_all = together(certificates)
    ahead = float(np.max(np.abs(root - z - course.law.reach))) / eps
    apart = max(ahead, *(one.apart for one in found))
    all_in_all = all_in_all._replace(
        distance=max(all_in_all.distance, apart),
        skipped=all_in_all.skipped + sum(one.wrong for one in found),
    )
    return all_in_all._replace(status=_status(all_in_all, found))


def _status(found: Certificate, stretches: list[_Found]) -> CertificateStatus:
    """The first test that fails."""
    if found.spacing > SETTINGS.coarsest:
        return CertificateStatus.UNRESOLVED
    if any(one.wrong for one in stretches):
        return CertificateStatus.TURN
    if found.status != CertificateStatus.OK:
        return found.status
    if any(one.open for one in stretches):
        return CertificateStatus.UNRESOLVED
    near = found.distance <= SETTINGS.farthest
    return CertificateStatus.OK if near else CertificateStatus.OFF


def _course(
    scene: Scene, effect: NapFlip, eps: float, viscosity: float, scale: float
) -> _Course:
    law = flipping_rod(scene, effect)
    assert isinstance(scene.potential, BristlePotential)
    rod: Any = scene.bristle
    parts = SceneParts(
        profile=scene.potential.profile,
        rod=rod,
        support=scene.support,
        load=scene.load,
        reach=jnp.asarray(law.reach),
        critical=jnp.asarray(law.critical),
    )
    sides = {side: RodSide.of(parts, side, eps) for side in (1, -1)}
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    stops = padded_edges(turns, scene.duration)
    return _Course(law, parts, sides, eps, viscosity, scale, turns, stops)


def _stretches(course: _Course, samples: TurningSamples) -> list[_Found]:
    found: list[_Found] = []
    change, pinned = None, None
    runs = samples.runs()
    for number, rows in enumerate(runs):
        some, later = samples.rows(rows), None
        if number + 1 < len(runs):
            first = runs[number + 1].start
            later = float(samples.ts[first]), int(samples.mode[first])
        if some.mode[0] == 0:
            assert change is not None
            assert pinned is not None
            one = course.bent(some, change, pinned, later)
        else:
            turns = later is not None and later[1] == 0
            one = course.straight(some, change, later[0] if later and turns else None)
            if later and not turns:  # from side to side, with nothing in between
                one = one._replace(apart=math.inf)
            pinned = one.pinned
        change = one.change
        found.append(one)
    return found


def _joined(
    some: TurningSamples, begins: _Change | None, ends: _Change | None
) -> tuple[_Column, _Column]:
    """Times and states of samples, from one change of mode to another."""
    ts, z = some.ts, some.z
    if begins is not None and not math.isnan(begins.time):
        ts, z = np.insert(ts, 0, begins.time), np.insert(z, 0, begins.z)
    if ends is not None and not math.isnan(ends.time):
        ts, z = np.append(ts, ends.time), np.append(z, ends.z)
    return ts, z


def _left(curve: tuple[_Column, _Column], later: float, z: float) -> tuple[_Change, float]:
    """When a root that goes on as it does comes to z, before `later`; and by how much in m
    it is short of it then."""
    ts, states = curve
    speed = (states[-1] - states[-2]) / (ts[-1] - ts[-2]) if ts.size > 1 else 0.0
    way, made = z - states[-1], speed * (later - ts[-1])
    time = _reached(float(ts[-1]), later, way, made)
    return _Change(time, z), max(abs(way) - max(made * np.sign(way), 0.0), 0.0)


def _reached(first: float, last: float, way: float, made: float) -> float:
    """When a `way` is done of which so much is made from a first to a last time; between
    them, and NaN where there is nothing between."""
    share = way / made if way * made > 0 else float(way != 0)
    share = min(max(share, SETTINGS.aside), 1 - SETTINGS.aside)
    time = first + share * (last - first)
    return time if first < time < last else math.nan
