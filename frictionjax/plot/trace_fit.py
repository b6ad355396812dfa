"""Picture of a fit to a trace: data and fit, residuals, slopes with their errors."""

from typing import Any

import jax
import numpy as np

from .style import GUIDE, LIMIT, STRIP, colour, new_figure, styled

_BAND = 2.0  # standard errors
_FLATTEST = 1e-12  # range of slopes that an axis shows
_NAMES = {"force": "force $\\ell - \\Phi'(z)$ (N)", "z": "state z (m)"}


@styled
def draw_trace_fit(fit: Any, truth: Any = None, figure: Any = None) -> Any:
    """Draw the result of `fit_trace`, `fit`.

    Left: the trace and what the surface found gives, and below residuals in standard
    deviations. Right: the slope w' with twice its standard error, phases that the trace
    does not determine in grey, and below where the tip was at the samples. `truth`: a
    profile to draw beside it. `figure`: a matplotlib Figure or SubFigure to draw into,
    which is returned.

    >>> trace = fx.simulate_trace(scene, eps=0.1, noise=0.001)
    >>> fit = fx.fit_trace(trace, scene, eps=0.1, harmonics=2, progress=False)
    >>> figure = fx.plot.draw_trace_fit(fit, truth=scene.profile)
    >>> [axes.get_xlabel() for axes in figure.axes]
    ['t (s)', 'phase y (periods)', 't (s)', 'phase y (periods)']
    """
    drawn, grid = new_figure(2, 2, 10.5, 6.2, figure)
    _data(grid[0, 0], fit)
    _residuals(grid[1, 0], fit)
    _slopes(grid[0, 1], fit, truth)
    _errors(grid[1, 1], fit)
    name = fit.status.name.replace("_", " ").lower()
    share = f"{fit.identifiability.share:.0%} of the period determined"
    title = f"{name}; {share}; reduced $\\chi^2$ = {fit.reduced_chi2:.3g}"
    drawn.suptitle(title, x=0.01, ha="left", fontsize=11)
    return drawn


def _data(axes: Any, fit: Any) -> None:
    trace, left = fit.trace, ~fit.used
    look = {"linestyle": "none", "markersize": 3}
    axes.plot(trace.ts, fit.achieved, color=colour(0), linewidth=1, label="fit")
    used = fit.used
    axes.plot(
        trace.ts[used], trace.values[used], marker=".", color=LIMIT, label="trace", **look
    )
    if left.any():
        label = "in slips, left out" if fit.slipping.any() else "left out"
        known = {"marker": "x", "color": colour(1), "label": label}
        axes.plot(trace.ts[left], trace.values[left], **known, **look | {"markersize": 5})
    axes.set(xlabel="t (s)", ylabel=_NAMES[trace.quantity])
    axes.set_title("Trace")
    axes.margins(x=0, y=0.22)
    axes.legend(loc="upper right", ncols=3)


def _residuals(axes: Any, fit: Any) -> None:
    used, size = fit.used, fit.residuals / fit.deviation
    axes.axhline(0, color=GUIDE, linewidth=1)
    axes.plot(fit.trace.ts[used], size[used], ".", color=colour(0), markersize=3)
    axes.set(xlabel="t (s)", ylabel="fit minus trace (standard deviations)")
    typical = float(np.median(fit.deviation))
    axes.set_title(f"Residuals of the samples used; 1 is {typical:.2g} {_unit(fit)}")
    axes.margins(x=0)


def _unit(fit: Any) -> str:
    return "m" if fit.trace.quantity == "z" else "N"


def _slopes(axes: Any, fit: Any, truth: Any) -> None:
    seen = fit.identifiability
    _shade(axes, seen)
    low, high = float(np.min(seen.slope)), float(np.max(seen.slope))
    shown = np.minimum(_BAND * seen.standard_error, 10 * (high - low))
    band = {"color": colour(0), "alpha": 0.25, "linewidth": 0}
    axes.fill_between(
        seen.phases, seen.slope - shown, seen.slope + shown, **band, label="2 errors"
    )
    axes.plot(seen.phases, seen.slope, color=colour(0), label="found")
    if truth is not None:
        slopes = np.asarray(jax.vmap(jax.grad(truth))(seen.phases))
        axes.plot(seen.phases, slopes, "--", color=LIMIT, linewidth=1.2, label="truth")
        low, high = min(low, slopes.min()), max(high, slopes.max())
    room = 0.25 * max(high - low, _FLATTEST)
    axes.set(xlim=(0, 1), ylim=(low - room, high + 1.6 * room))
    axes.set(xlabel="phase y (periods)", ylabel="slope w' (1)")
    axes.set_title("Surface; grey: not determined")
    axes.legend(loc="upper right", ncols=3)


def _shade(axes: Any, seen: Any) -> None:
    half = 0.5 / seen.phases.size
    for phase in seen.phases[~seen.determined]:
        axes.axvspan(phase - half, phase + half, color=STRIP, linewidth=0, zorder=0)


def _errors(axes: Any, fit: Any) -> None:
    seen = fit.identifiability
    _shade(axes, seen)
    axes.semilogy(seen.phases, seen.standard_error, color=colour(0), label="of w'")
    label = "of a local bump alone"
    axes.semilogy(seen.phases, seen.local, ":", color=colour(2), label=label)
    base = np.nanmin(seen.local[np.isfinite(seen.local)], initial=1.0)
    tips = fit.tips[fit.used]
    marks = {"color": LIMIT, "linestyle": "none", "marker": "|", "markersize": 7}
    axes.plot(tips, np.full(tips.size, 0.5 * base), **marks, label="tips at samples")
    top = 3 * float(np.ptp(seen.slope))
    axes.set(xlim=(0, 1), ylim=(0.25 * base, max(top, base)))
    axes.set(xlabel="phase y (periods)", ylabel="standard error (1)")
    axes.set_title("What the trace determines")
    axes.legend(loc="upper right", fontsize=8)
