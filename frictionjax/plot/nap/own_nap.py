"""Both effects of the nap against the angle, for a rod of the user's own (Section 3.4)."""

from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from ..._checks import kind_of, require
from ...bristles import AngularSpring
from ...contact import Nap, nap
from ...model import friction
from ...profiles import AbstractProfile
from ...rods import hinged_load
from ...turning import axial_force
from ..style import GUIDE, STRIP, colour, new_figure, styled

_NAMES = ("with the nap", "against it", "turned over, against it")
_STYLES = ("-", "-", "--")


class _Family(NamedTuple):
    """Over angles (n,) in rad: slides with, against, turned over and back, (4, n) in N."""

    angles: np.ndarray
    friction: np.ndarray
    compression: np.ndarray


@styled
def draw_own_nap(
    profile: AbstractProfile, bristle: AngularSpring, bending_stiffness: Any = None
) -> Figure:
    """Friction and compression against theta_lim, of rods with the same root height.

    A dot marks the `bristle` given, on the surface `profile`. Right: compressions, shaded
    where a critical load turns a rod over against the nap and only then, and with
    `bending_stiffness` (N m^2) the critical load `pi^2 B/L^2`.

    Raises `ValueError` as `nap` does, and for a bristle that is no rod.

    >>> rod = fx.bristles.AngularSpring(1.0, length=1.4, height=1.0, rest_angle=0.3)
    >>> figure = fx.plot.draw_own_nap(fx.profiles.Sine(slope=0.5), rod)
    >>> figure.axes[1].get_legend_handles_labels()[1]
    ['critical loads that turn it over', 'with the nap', 'against it', 'turned over, ...
    """
    found = nap(profile, bristle, bending_stiffness)
    rod = isinstance(bristle, AngularSpring)
    require(rod, "bristle", kind_of(bristle), "an AngularSpring")
    family = _family(profile, bristle)
    figure, grid = new_figure(1, 2, 9.6, 4.4)
    here = float(bristle.limit_angle)
    rows = (found.rho_with, found.rho_against, found.rho_flipped)
    _lines(grid[0, 0], family.angles, family.friction, here, rows)
    grid[0, 0].set(ylabel="friction (N)", title="Friction, eps \N{RIGHTWARDS ARROW} 0")
    grid[0, 0].legend(loc="best")
    _compressions(grid[0, 1], family, here, found)
    if bending_stiffness is not None:
        lengths = float(bristle.height) / np.cos(family.angles)
        load = np.asarray(hinged_load(float(bending_stiffness), lengths))
        label = "critical load $\\pi^2 B/L^2$"
        grid[0, 1].plot(family.angles, load, ":", color="#222222", label=label)
    grid[0, 1].legend(loc="best")
    return figure


def _family(profile: AbstractProfile, bristle: AngularSpring) -> _Family:
    """Rods at every angle that clears the surface and presses, standing and turned over."""
    law = friction(profile, bristle)
    low, high = float(law.omega_minus), float(law.omega_plus)
    rest = float(bristle.rest_angle)
    least = max(abs(rest), np.arctan(max(high, -low)))
    most = np.arctan(1 / max(high, -low))
    shares = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, 402)[1:-1])
    angles = least + (most - least) * shares
    sides = [_slides(bristle, angles, side * rest) for side in (1, -1)]
    slopes = ((0, high), (0, low), (1, -low), (1, -high))
    normals = np.array([sides[i] / (1 + o / np.tan(angles)) for i, o in slopes])
    forces = normals * np.array([o for _, o in slopes])[:, None]
    axial = axial_force(normals, forces, angles)
    return _Family(angles, np.abs(forces), -axial)


def _slides(bristle: AngularSpring, angles: np.ndarray, rest: float) -> np.ndarray:
    """alpha in N at each angle (rad) of rods whose root is as high."""
    reach = float(bristle.height) * np.tan(angles)
    return float(bristle.stiffness) * (angles - rest) / reach


def _lines(axes: Any, angles: Any, rows: np.ndarray, here: float, own: Any) -> None:
    for index in range(3):
        axes.plot(
            angles, rows[index], _STYLES[index], color=colour(index), label=_NAMES[index]
        )
        axes.plot([here], [own[index]], "o", color=colour(index))
    axes.axvline(here, color=GUIDE, linewidth=0.8, linestyle="--")
    axes.set(xlabel="limit angle $\\theta^{lim}$ (rad)")
    # Forces have no bound where the angles end.
    axes.set(xlim=(0, 0.5 * np.pi), ylim=(0, 2.2 * np.nanmax(own)))


def _compressions(axes: Any, family: _Family, here: float, found: Nap) -> None:
    own = (-found.axial_with, -found.axial_against, -found.axial_flipped)
    rows = family.compression
    least = np.maximum(rows[0], rows[2])
    greatest = np.minimum(rows[1], rows[3])
    label = "critical loads that turn it over"
    open_ = greatest > least
    axes.fill_between(family.angles, least, greatest, open_, color=STRIP, label=label)
    _lines(axes, family.angles, rows, here, own)
    axes.set(ylabel="compression (N)", title="Compression along the rod")
