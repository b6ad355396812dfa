"""A trajectory over the strip and the limit of its scene."""

from typing import Any, NamedTuple

import numpy as np

from .._checks import eps_of, require, scene_of
from ..effects import nap_flip_among
from ..limit import LimitSolution, solve_limit
from ..model import Scene, coefficients_jit, composed, strips_at
from ..sweeps import without_noise
from .style import LIMIT, STRIP, axes_of, colour, new_figure, styled
from .trajectories import frame_window, window_of_slips

_TIMES = 801  # of the strip and the limit


@styled
def draw_solution(solution: Any, ax: Any = None) -> Any:
    """Draw z in m against t in s of a `solution`, of `solve` or `solve_limit`.

    A Figure, or `ax` where it is drawn into that.

    Shaded: the strip of states that friction holds; dashed: the limit, where z0 lies in the
    strip. A panel beside it, of a figure of its own, follows a few slips, where the times
    resolve them. Of a compliant array z is the mean, with a standard deviation on both
    sides. Of a rod that turns over also its root, and shaded where it is in between.

    Raises `ValueError` for a batch, and where no scene is known of the solution.

    >>> figure = fx.plot.draw_solution(fx.solve(scene, eps=0.01))
    >>> figure.axes[0].get_legend_handles_labels()[1]
    ['strip [z$_-$, z$_+$]', 'z', 'limit z']
    """
    scene = scene_of(solution)
    require(np.ndim(solution.z) == 1, "solution", "a batch", "one trajectory")
    known = _Limit.of(scene, np.asarray(solution.ts))
    window = None if ax is not None else _few_slips(solution, known)
    if window is None:
        drawn, axes = axes_of(ax, 7.2, 4.4)
    else:
        drawn, grid = new_figure(1, 2, 10.8, 4.4)
        axes = grid[0, 0]
        _panel(grid[0, 1], solution, scene, known)
        ts, z = np.asarray(solution.ts), np.asarray(solution.z)
        inside = z[(ts >= window[0]) & (ts <= window[1])]
        frame_window(axes, grid[0, 1], window, inside)
    _panel(axes, solution, scene, known)
    axes.set_title("Trajectory" if solution.ok else solution.message)
    axes.legend(loc="best")
    return drawn


class _Limit(NamedTuple):
    """Times in s, of a solution and between, and the limit then; None: there is none."""

    ts: np.ndarray
    z: np.ndarray | None

    @classmethod
    def of(cls, scene: Scene, ts: np.ndarray) -> "_Limit":
        fine = np.unique(np.concatenate([ts, np.linspace(ts[0], ts[-1], _TIMES)]))
        try:
            return cls(fine, np.asarray(solve_limit(without_noise(scene), fine).z))
        except ValueError:  # z0 lies outside the strip
            return cls(fine, None)


def _few_slips(solution: Any, limit: _Limit) -> tuple[float, float] | None:
    eps = eps_of(solution)
    if eps is None or limit.z is None:
        return None
    ts = np.asarray(solution.ts)
    return window_of_slips(ts, np.interp(ts, limit.ts, limit.z), float(eps))


def _panel(axes: Any, solution: Any, scene: Scene, limit: _Limit) -> None:
    ts, z = np.asarray(solution.ts), np.asarray(solution.z)
    if nap_flip_among(scene.effects) is None:
        _strip(axes, scene, limit.ts)
    else:
        _turning(axes, solution)
    if isinstance(solution, LimitSolution):
        axes.plot(ts, z, color=LIMIT, label="limit z")
    else:
        axes.plot(ts, z, color=colour(0), label="z")
        _spread(axes, ts, z, solution.counts.get("spread"))
        look = {"color": LIMIT, "linewidth": 1.2, "linestyle": "--"}
        if limit.z is not None:
            axes.plot(*limit, **look, label="limit z")
    axes.set(xlabel="t (s)", ylabel="z (m)")
    axes.margins(x=0)


def _strip(axes: Any, scene: Scene, ts: np.ndarray) -> None:
    law = coefficients_jit(composed(scene).potential)
    _, low, high = strips_at(scene, float(law.rho_plus), float(law.rho_minus), ts)
    label = "strip [z$_-$, z$_+$]"
    axes.fill_between(ts, low, high, color=STRIP, linewidth=0, label=label)


def _turning(axes: Any, solution: Any) -> None:
    ts, between = np.asarray(solution.ts), np.asarray(solution.mode) == 0
    across = axes.get_xaxis_transform()
    look = {"color": STRIP, "linewidth": 0, "zorder": 0, "label": "bent over its tip"}
    if between.any():
        axes.fill_between(ts, 0, 1, between, transform=across, **look)
    axes.plot(ts, np.asarray(solution.root), color=colour(1), label="root u")


def _spread(axes: Any, ts: np.ndarray, z: np.ndarray, spread: Any) -> None:
    if spread is not None:
        apart = np.asarray(spread)
        look = {"color": colour(0), "alpha": 0.25, "linewidth": 0}
        axes.fill_between(ts, z - apart, z + apart, **look, label="spread")
