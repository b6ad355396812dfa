"""Pictures of inverse design: the surface found, what is left open, starts and targets."""

from typing import Any

import numpy as np

from ..profiles import Fourier
from .style import GUIDE, LIMIT, colour, marker, new_figure, styled

_POINTS = 1024
_FAMILY = 12
_FAMILY_LOOK = {"color": GUIDE, "linewidth": 0.8, "alpha": 0.7}


@styled
def draw_profile_fit(fit: Any, family: int = _FAMILY, figure: Any = None) -> Any:
    """Draw the result of `fit_profile`, `fit`.

    Above: heights and slopes of the surface, with `family` others that have the same
    coefficients in grey and the extreme slopes that the coefficients fix. Below: bending
    energy of every start, best first, and coefficients achieved against targets.
    `figure`: a matplotlib Figure or SubFigure to draw into, which is returned.

    >>> fit = fx.fit_profile(fx.Target(scene.bristle, rho_plus=0.12, rho_minus=-0.05))
    >>> [axes.get_xlabel() for axes in fx.plot.draw_profile_fit(fit, family=3).axes]
    ['y (periods)', 'y (periods)', 'start, best first (1)', 'target (N)']
    """
    drawn, grid = new_figure(2, 2, 10.0, 7.2, figure)
    others = fit.family(family)
    _heights(grid[0, 0], fit, others)
    _slopes(grid[0, 1], fit, others)
    _waterfall(grid[1, 0], fit)
    _targets(grid[1, 1], fit)
    drawn.suptitle(_sentence(fit), x=0.01, ha="left", fontsize=11)
    return drawn


def _sentence(fit: Any) -> str:
    unseen = fit.open_directions.shape[0]
    seen = f"{fit.rank} directions seen, {unseen} left open"
    return f"{fit.status.name.replace('_', ' ').lower()}; {seen}"


def drawn_series(profile: Fourier, order: int) -> tuple[np.ndarray, np.ndarray]:
    """A derivative of the profile over one period, centred on its steepest ascent."""
    cos, sin = np.asarray(profile.cos), np.asarray(profile.sin)
    turns = 2 * np.pi * np.arange(1, cos.size + 1)
    y = np.linspace(-0.5, 0.5, _POINTS + 1)
    waves = (cos - 1j * sin) * (1j * turns) ** order
    return y, (waves @ np.exp(1j * np.outer(turns, y))).real


def _heights(axes: Any, fit: Any, others: list[Fourier]) -> None:
    for index, other in enumerate(others):
        label = "same coefficients" if index == 0 else None
        axes.plot(*drawn_series(other, 0), **_FAMILY_LOOK, label=label)
    label = f"least bent: $\\int w''^2$ = {fit.bending_energy:.4g}"
    axes.plot(*drawn_series(fit.profile, 0), color=colour(0), linewidth=2, label=label)
    axes.set(xlabel="y (periods)", ylabel="height w (periods)")
    axes.set_title("Surface")
    axes.margins(x=0)
    axes.legend(loc="upper left")


def _slopes(axes: Any, fit: Any, others: list[Fourier]) -> None:
    for other in others:
        axes.plot(*drawn_series(other, 1), **_FAMILY_LOOK)
    y, slopes = drawn_series(fit.profile, 1)
    axes.plot(y, slopes, color=colour(0), linewidth=2)
    axes.set(xlabel="y (periods)", ylabel="slope w' (1)")
    axes.margins(x=0, y=0.12)
    found = fit.coefficients[0]
    if found.omega_plus is None:
        axes.set_title("Slopes: tips on one root see a sum of them")
        return
    ends = [("$\\omega_+$", found.omega_plus), ("$\\omega_-$", found.omega_minus)]
    for name, value in ends:
        axes.axhline(float(value), color=LIMIT, linestyle="--", linewidth=1)
        axes.annotate(
            f"{name} = {float(value):.4g}",
            (0.5, float(value)),
            xytext=(-4, 4 if value > 0 else -4),
            textcoords="offset points",
            ha="right",
            va="bottom" if value > 0 else "top",
        )
    axes.set_title("Slopes: the coefficients see the dashed lines only")


def _waterfall(axes: Any, fit: Any) -> None:
    places = np.arange(1, len(fit.starts) + 1)
    names = [start.status.name.replace("_", " ").lower() for start in fit.starts]
    energies = np.array([start.bending_energy for start in fit.starts])
    axes.plot(places, energies, color=GUIDE, linewidth=1, zorder=1)
    run = np.array([start.ran for start in fit.starts])
    for index, name in enumerate(dict.fromkeys(names)):
        chosen = np.array([one == name for one in names]) & run
        look = {"color": colour(index), "marker": marker(index), "linestyle": "none"}
        axes.plot(places[chosen], energies[chosen], **look, label=name)
    if not run.all():
        look = {"color": GUIDE, "marker": "o", "linestyle": "none", "fillstyle": "none"}
        axes.plot(places[~run], energies[~run], **look, label="not run: best is proven")
    if fit.bending_bound > 0:
        label = "proven lower bound"
        axes.axhline(fit.bending_bound, color=LIMIT, linestyle=":", label=label)
    axes.set(xlabel="start, best first (1)", ylabel="bending energy $\\int w''^2$ (1)")
    spread = np.ptp(energies) / np.max(energies)
    if spread < 1e-3:
        middle = float(energies[0])
        axes.set_ylim(0.9 * middle, 1.1 * middle)
    axes.set_xticks(places)
    axes.set_title(
        f"Starts: energies differ by {spread:.1g} of the largest"
        if np.sum(run) > 1
        else f"Starts: {np.sum(run)} of {run.size} run"
    )
    axes.legend()


def _targets(axes: Any, fit: Any) -> None:
    targets = np.asarray(fit.targets)
    worst = np.max(np.abs(fit.residuals), axis=0)
    names = ("|$\\rho_+$|", "|$\\rho_-$|")
    labels = [f"{n}, worst {w:.1g} N" for n, w in zip(names, worst, strict=True)]
    against(axes, targets, targets + np.asarray(fit.residuals), labels)
    axes.set(xlabel="target (N)", ylabel="achieved (N)")
    axes.set_title(f"Coefficients: largest relative error {fit.largest_error:.1g}")
    axes.legend(loc="upper left")


def against(axes: Any, targets: np.ndarray, achieved: np.ndarray, labels: list) -> None:
    """Sizes achieved over those wanted, (targets, 2), and the line on which they agree."""
    wanted, found = np.abs(targets), np.abs(achieved)
    for index, label in enumerate(labels):
        look = {"color": colour(index), "marker": marker(index), "linestyle": "none"}
        pairs = wanted[:, index], found[:, index]
        axes.plot(*pairs, **look, markersize=8 - 3 * index, label=label)
    high = 1.15 * max(float(np.max(wanted)), float(np.nanmax(found, initial=0.0)))
    axes.plot([0, high], [0, high], color=LIMIT, linewidth=1, zorder=1)
    axes.set(xlim=(0, high), ylim=(0, high))
