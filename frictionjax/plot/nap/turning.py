"""A bristle that turns over, from instant to instant, and its way and force meanwhile."""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ..._checks import require
from ...contact import mechanics
from ...effects import nap_flip_among
from ...model import Scene
from ...turning import FlippingRod, flipping_rod
from ..moving import friction_levels, rod_between
from ..style import GUIDE, LIMIT, STRIP, Picture, colour, draw_level, styled

_BENT = (0.5, 0.0, -0.5)  # where roots stand ahead of their tips, in reaches
_PERIODS = 400  # of the surface that are drawn, at most: more would be a grey bar


class _Instant(NamedTuple):
    """`time` in s, `root` and `tip` in m, what it shows; `side`: to the left of the way
    from tip to root (1) a bent rod is, or to the right (-1)."""

    time: float
    root: float
    tip: float
    name: str
    side: int


@styled
def draw_turning(scene: Scene, solution: Any, eps: Any = None) -> Figure:
    """Draw how the rod of a `scene` with `effects.NapFlip` turns over for the first time.

    `solution`: of `solve`, with its `eps` in m, or of `solve_limit`, whose surface is flat.
    Above: the bristle where it slides with its nap, is held when pulled against it, comes
    to its critical load, stands bent over its pinned tip, and has turned over. Bent rods
    are elasticas between hinges, whose energy does not tell to which side they bend: drawn
    is the side that the root goes to. Below: root and tip, and the force on the root,
    against time, those instants marked, shaded where the rod is in between.

    Raises `ValueError` as `mechanics` does, for a scene without the effect, and for a
    solution in which nothing turns over.

    >>> rough, load = fx.profiles.Sine(slope=0.5), fx.loads.Triangle(2.5, period=3.0)
    >>> rod = fx.bristles.AngularSpring(1.0, length=1.4, height=1.0, rest_angle=0.3)
    >>> flips = (fx.effects.NapFlip(bending_stiffness=0.1),)
    >>> turning = scene.replace(profile=rough, bristle=rod, load=load, effects=flips)
    >>> print(fx.plot.draw_turning(turning, fx.solve_limit(turning)).axes[-1].get_ylabel())
    force on the root (N)
    """
    effect = nap_flip_among(scene.effects)
    require(effect is not None, "scene.effects", "none of NapFlip", "effects.NapFlip")
    assert effect is not None
    data, law = mechanics(scene, solution, eps), flipping_rod(scene, effect)
    instants = _instants(data, law)
    figure = Picture(figsize=(11.4, 7), layout="constrained")
    grid = figure.add_gridspec(3, len(instants), height_ratios=[0.7, 1.2, 1])
    strip = [figure.add_subplot(grid[0, i]) for i in range(len(instants))]
    for index, (axes, instant) in enumerate(zip(strip, instants, strict=True)):
        _bristle(axes, scene, law, eps, instant)
        axes.set_title(f"{_letter(index)}  {instant.name}", fontsize=8.5)
    way = figure.add_subplot(grid[1, :])
    force = figure.add_subplot(grid[2, :], sharex=way)
    _way(way, data, instants)
    _force(force, data, scene, instants)
    return figure


def _letter(index: int) -> str:
    return "abcdefgh"[index]


def _instants(data: xr.Dataset, law: FlippingRod) -> list[_Instant]:
    mode, time = data["mode"].values, data.time.values
    root, tip = data.u.values, data.p.values
    turned = np.flatnonzero(mode[1:] != mode[:-1])
    needs = "one in which the rod turns over: a larger load, or more times"
    require(turned.size > 0, "solution", "one that stays in its mode", needs)
    last = int(turned[0])  # before it turns
    way, foot = -int(mode[last]), float(tip[last])
    found = []

    def add(index: int, name: str) -> None:
        now, at, below = (float(v[index]) for v in (time, root, tip))
        found.append(_Instant(now, at, below, name, -way))

    furthest = int(np.argmax(-way * root[: last + 1]))
    if furthest > 0:
        middle = 0.5 * (root[0] + root[furthest])
        nearest = np.abs(root[: furthest + 1] - middle)
        add(int(np.argmin(nearest)), "slides with nap")
    if last > furthest + 1:
        add((furthest + last) // 2, "held against it")
    add(last, "critical load")
    gone = way * (root[last:] - foot)
    for share in _BENT:
        place = -way * law.reach * share
        past = np.flatnonzero(gone >= way * place)
        if past.size and past[0] > 0:
            rows = last + past[0] + np.array([-1, 0])[::way]  # in rising order of place
            at = float(np.interp(place, root[rows] - foot, time[rows]))
            name = "bent over its tip"
            found.append(_Instant(at, foot + place, foot, name, -way))
    after = np.flatnonzero((mode == way) & (np.arange(mode.size) > last))
    if after.size:
        end = np.flatnonzero((mode != way) & (np.arange(mode.size) > after[0]))
        until = int(end[0]) if end.size else mode.size
        rows = np.arange(after[0], until)
        middle = 0.5 * (root[rows[0]] + way * np.max(way * root[rows]))
        add(int(rows[np.argmin(np.abs(root[rows] - middle))]), "turned over")
    return found


def _bristle(
    axes: Any, scene: Scene, law: FlippingRod, eps: Any, instant: _Instant
) -> None:
    """The rod at an instant, over as much of the surface as it could reach."""
    profile: Any = scene.profile
    length, reach = float(law.bent.length), law.reach
    x, depth = instant.tip, 0.12 * length
    ground = np.linspace(x - 1.2 * reach, x + 1.2 * reach, 2001)
    low = np.zeros_like(ground)
    foot = 0.0
    if eps is not None:
        foot = float(eps * profile(x / eps))
        if np.ptp(ground) < _PERIODS * eps:
            low = np.asarray(eps * profile(ground / eps))
    axes.fill_between(ground - x, low, -depth, color=STRIP, linewidth=0)
    axes.plot(ground - x, low, color=GUIDE, linewidth=0.8)
    root, tip = np.array([instant.root - x, float(law.bent.height)]), np.array([0.0, foot])
    points = rod_between(root, tip, length, instant.side)
    axes.plot(*points, color=colour(0), linewidth=2.2)
    axes.plot([0], [foot], "o", color=colour(1), markersize=4)
    axes.plot([instant.root - x], [float(law.bent.height)], "s", color=LIMIT, markersize=5)
    top = float(law.bent.height) + depth
    axes.set(xlim=(-1.2 * reach, 1.2 * reach), ylim=(-depth, top))
    axes.set_aspect("equal")
    axes.set_axis_off()


def _marks(axes: Any, instants: list[_Instant]) -> None:
    for index, instant in enumerate(instants):
        axes.axvline(instant.time, color=GUIDE, linewidth=0.8, linestyle=":")
        top = (instant.time, 1.0)
        axes.annotate(
            _letter(index),
            top,
            xycoords=axes.get_xaxis_transform(),
            xytext=(0, 2),
            textcoords="offset points",
            ha="center",
            color="#555555",
        )


def _way(axes: Any, data: xr.Dataset, instants: list[_Instant]) -> None:
    time = data.time.values
    axes.plot(time, data.u, color=colour(0), label="root u")
    axes.plot(time, data.p, color=colour(1), label="tip p")
    _shade(axes, data)
    _marks(axes, instants)
    axes.set(ylabel="place (m)")
    axes.tick_params(labelbottom=False)
    axes.margins(x=0)
    axes.legend(loc="best")


def _force(axes: Any, data: xr.Dataset, scene: Scene, instants: list[_Instant]) -> None:
    axes.plot(data.time, data.support_force, color=LIMIT, linewidth=1.2)
    for level, name in friction_levels(scene):
        draw_level(axes, level, name)
    _shade(axes, data)
    _marks(axes, instants)
    axes.set(xlabel="t (s)", ylabel="force on the root (N)")


def _shade(axes: Any, data: xr.Dataset) -> None:
    """Where the rod is in between."""
    between = data["mode"].values == 0
    where = axes.get_xaxis_transform()
    label = "in between" if between.any() else None
    axes.fill_between(
        data.time,
        0,
        1,
        between,
        transform=where,
        color=STRIP,
        linewidth=0,
        label=label,
        zorder=0,
    )
