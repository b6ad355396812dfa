"""A bristle over its surface, drawn once and then moved."""

from typing import Any

import numpy as np
from matplotlib.patches import Polygon

from ..style import GUIDE, LIMIT, STRIP, colour
from .places import Drawn, Places
from .shapes import coil, rod_between, turns_within

_PERIODS = 400  # of the surface that are drawn, at most: more would be a grey bar
_POINTS = 24  # a period
_WIDEST = 6.0  # sizes of the bristle: of a longer way a part is shown, which follows
_DEEP = 0.18  # sizes: ground below the surface
_ASIDE = 3.0  # points: letters of both ends of a spring from these
_ARC = 0.34  # sizes: how far from the root its angle is marked


class BristleArtist:
    """Lines and dots of `places` in `axes`; `move_to` a row of them.

    The ground, the bristle as a rod or a spring with its tip and its root, the spring of
    the support with its far end, and the angle from the vertical, > 0 to the left, with
    that at rest dashed.
    """

    def __init__(self, axes: Any, places: Places, wide: float = 0.0):
        """`wide`: the axes are to be at least so many times as wide as they are high."""
        self.axes, self.places = axes, places
        deep, top = _DEEP * places.size, float(np.max(places.root[:, 1]))
        top += 0.3 * places.size
        low, high = places.ends
        pad = max(0.25 * places.size, 0.5 * (wide * (top + deep) - (high - low)))
        self._low, self._high = low - pad, high + pad
        most = max(_WIDEST * places.size, wide * (top + deep))
        self._width = min(self._high - self._low, most)
        draw_ground(axes, places, self._low, self._high, deep)
        self._angle_artists()
        self._coil = 0.1 * places.size
        self._turns = self._support_turns()
        self.spring = axes.plot([], [], color=LIMIT, linewidth=0.9, label="spring")[0]
        thick = {Drawn.ROD: 2.6, Drawn.SPRING: 1.4, Drawn.UNKNOWN: 1.0}[places.kind]
        style = "--" if places.kind is Drawn.UNKNOWN else "-"
        name = "link" if places.kind is Drawn.UNKNOWN else "bristle"
        self.bristle = axes.plot(
            [], [], style, color=colour(0), linewidth=thick, label=name
        )[0]
        dots = (("o", colour(1), "tip p"), ("s", LIMIT, "root u"), ("o", LIMIT, "end q"))
        self.tip, self.root, self.far = (
            axes.plot([], [], shape, color=shade, markersize=4.5, label=name, zorder=4)[0]
            for shape, shade, name in dots
        )
        self._letters = [_letter(axes, name) for name in "puq"]
        self._title = axes.set_title(" ")
        axes.set(ylim=(-deep, top), xlabel="x (m)", ylabel="height (m)")
        axes.set_aspect("equal")
        axes.grid(False)

    def _angle_artists(self) -> None:
        corner = np.zeros((3, 2))
        self.wedge = Polygon(corner, closed=True, color=colour(5), alpha=0.45, linewidth=0)
        self.axes.add_patch(self.wedge)
        self.vertical, self.rest = (
            self.axes.plot([], [], style, color=GUIDE, linewidth=0.9)[0]
            for style in ("-", "--")
        )
        known = self.places.kind is not Drawn.UNKNOWN
        for one in (self.wedge, self.vertical):
            one.set_visible(known)
        self.rest.set_visible(self.places.rest_angle is not None)
        if known:
            self.wedge.set_label("angle $\\theta$, > 0 to the left")
        if self.places.rest_angle is not None:
            self.rest.set_label("$\\theta$ at rest")

    def _support_turns(self) -> int:
        """As many as fit at the spring's longest, so that they stay the same all along."""
        if self.places.far is None:
            return 1
        lengths = np.abs(self.places.far - self.places.root[:, 0])
        return turns_within(float(np.max(lengths)), self._coil)

    def move_to(self, row: int) -> None:
        """Draw everything where it is at a time."""
        places = self.places
        root, tip = places.root[row], places.tip[row]
        self.bristle.set_data(*self._bristle(root, tip, int(places.side[row])))
        self.tip.set_data([tip[0]], [tip[1]])
        self.root.set_data([root[0]], [root[1]])
        ends = [tip, root]
        if places.far is not None:
            far = np.array([places.far[row], root[1]])
            self.spring.set_data(*coil(root, far, self._coil, self._turns))
            self.far.set_data([far[0]], [far[1]])
            ends.append(far)
        for letter, end in zip(self._letters, ends, strict=False):
            letter.xy = tuple(end)
            letter.set_visible(True)
        if places.far is not None:
            self._part_letters(float(np.sign(places.far[row] - root[0])) or 1.0)
        self._turn_angle(root, float(places.angle[row]))
        self._look_at(root)
        self._title.set_text(self._told(row))

    def _part_letters(self, side: float) -> None:
        """Of root and far end, to the right where `side` is 1: the spring may be short."""
        for letter, way in zip(self._letters[1:], (-side, side), strict=True):
            letter.xyann = (_ASIDE * way, letter.xyann[1])
            letter.set_horizontalalignment("left" if way > 0 else "right")

    def _bristle(self, root: np.ndarray, tip: np.ndarray, side: int) -> np.ndarray:
        if self.places.kind is Drawn.SPRING:
            return coil(tip, root, self._coil)
        return rod_between(root, tip, self.places.length, side)

    def _turn_angle(self, root: np.ndarray, angle: float) -> None:
        if np.isnan(angle):
            return
        size = self.places.size
        arc = _below(root, np.linspace(0, angle, 31), _ARC * size)
        self.wedge.set_xy(np.vstack([root, arc]))
        self.vertical.set_data(*np.stack([root, root - [0, 1.3 * _ARC * size]], axis=1))
        if self.places.rest_angle is not None:
            end = _below(root, np.array([self.places.rest_angle]), 1.8 * _ARC * size)
            self.rest.set_data(*np.stack([root, end[0]], axis=1))

    def _look_at(self, root: np.ndarray) -> None:
        """All of the way where it is short, else a part of it around the root."""
        half = 0.5 * self._width
        middle = np.clip(root[0], self._low + half, self._high - half)
        self.axes.set_xlim(middle - half, middle + half)

    def _told(self, row: int) -> str:
        text = f"t = {self.places.time[row]:.4g} s"
        angle = self.places.angle[row]
        bent = "chord at " if self.places.side[row] else ""
        return text if np.isnan(angle) else f"{text}, {bent}$\\theta$ = {angle:+.3f} rad"


def draw_ground(axes: Any, places: Places, low: float, high: float, deep: float) -> None:
    """The surface between two places in m, as flat as it is in the limit."""
    eps = places.eps
    wiggly = eps is not None and (high - low) < _PERIODS * eps
    count = 2
    if wiggly:
        assert eps is not None
        count += int(_POINTS * (high - low) / eps)
    x = np.linspace(low, high, count)
    up = places.height(x) if wiggly else np.zeros_like(x)
    axes.fill_between(x, up, -deep, color=STRIP, linewidth=0)
    axes.plot(x, up, color=GUIDE, linewidth=0.8)


def _below(root: np.ndarray, angles: np.ndarray, far: float) -> np.ndarray:
    """Places (n, 2) so far from the root, at angles > 0 to the left of the vertical."""
    return root - far * np.stack([np.sin(angles), np.cos(angles)], axis=1)


def _letter(axes: Any, name: str) -> Any:
    below = name == "p"
    letter = axes.annotate(
        name,
        (0, 0),
        xytext=(0, -5 if below else 5),
        textcoords="offset points",
        ha="center",
        va="top" if below else "bottom",
        style="italic",
        annotation_clip=True,
    )
    letter.set_visible(False)
    return letter
