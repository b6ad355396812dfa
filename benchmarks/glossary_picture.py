"""Picture of the glossary: wells and folds, slides and slips, a bracket of two lanes.

Writes frictionjax/glossary.png, of the vertical bristle on a sine at eps = 0.05.
"""

from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
from matplotlib.axes import Axes
from scipy.integrate import solve_ivp

import frictionjax as fx
from frictionjax.plot.style import LIMIT, STRIP, colour, new_figure, styled

EPS, GAMMA = 0.05, 1.0
TARGET = Path(__file__).parents[1] / "frictionjax" / "glossary.png"
jax.config.update("jax_enable_x64", True)
SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.0488, 3.0),
    3.0,
)
BOX = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.85}


def wiggly_force(z):
    return jax.vmap(lambda x: SCENE.potential.force(x, EPS))(jnp.asarray(z))


def say(axes: Axes, text: str, at: tuple, label: tuple) -> None:
    """A word of the glossary, with an arrow to what it means."""
    arrow = {"arrowstyle": "-", "color": LIMIT, "lw": 0.8}
    axes.annotate(text, at, label, arrowprops=arrow, ha="center", bbox=BOX)


def draw_wells(axes: Axes) -> None:
    """Forces over z: where the tip can rest, and where it must leave."""
    z = np.linspace(0.0, 3 * EPS, 601)
    force, law = np.asarray(wiggly_force(z)), fx.friction(SCENE)
    rising = np.gradient(force, z) > 0
    axes.plot(z, force, color=colour(0), lw=1, ls=":")
    axes.plot(z, np.where(rising, force, np.nan), color=colour(0), lw=2.5)
    top = EPS, float(law.rho_plus)
    axes.plot(z, top[1] - (z - top[0]), color=colour(1))
    axes.axhline(top[1], color=LIMIT, lw=0.8, ls="--")
    axes.axhline(float(law.rho_minus), color=LIMIT, lw=0.8, ls="--")
    axes.plot(*top, "o", color=LIMIT)
    axes.set_ylim(-0.19, 0.23)
    say(axes, "fold: the branch\nends at $\\rho_+$", top, (0.7 * EPS, 0.18))
    middle = 1.75 * EPS, float(wiggly_force([1.75 * EPS])[0])
    say(axes, "well: a tip can rest\nwhere the force rises", middle, (2.0 * EPS, -0.15))
    pull = 2.3 * EPS, top[1] - 1.3 * EPS
    say(axes, "pull $l - \\Phi'(z)$", pull, (2.4 * EPS, 0.16))
    axes.text(0.03 * EPS, -0.115, "$\\rho_-$", bbox=BOX)
    axes.set(xlabel="z (m)", ylabel="force (N)", title="Wells and folds: $V_\\epsilon'$")


def draw_slides(axes: Axes) -> None:
    """A trajectory beside its limit."""
    t = np.linspace(0.0, 1.5, 1501)
    run, limit = fx.solve(SCENE, EPS, GAMMA, t), fx.solve_limit(SCENE, t)
    law = fx.friction(SCENE)
    load = np.asarray(jax.vmap(SCENE.load)(jnp.asarray(t)))
    edges = load - float(law.rho_plus), load - float(law.rho_minus)
    axes.fill_between(t, *edges, color=STRIP, lw=0)
    axes.plot(t, limit.z, "--", color=LIMIT, lw=1.2)
    axes.plot(t, run.z, color=colour(0))
    z, zl = np.asarray(run.z), np.asarray(limit.z)
    slip = 40 + np.argmax(np.diff(z[40:600]))
    say(axes, "slip: into the next well", (t[slip], z[slip]), (0.62, 0.05))
    lag = 400 + np.argmax(np.abs(z - zl)[400:600])
    say(axes, "lag", (t[lag], 0.5 * (z[lag] + zl[lag])), (0.62, 0.42))
    say(
        axes,
        "slide: the limit\nfollows the edge",
        (0.33, np.interp(0.33, t, zl)),
        (0.3, 1.0),
    )
    say(axes, "rest", (1.05, np.interp(1.05, t, zl)), (1.1, 1.12))
    say(axes, "strip $[z_-, z_+]$", (1.2, np.interp(1.2, t, edges[0]) + 0.03), (1.25, 0.05))
    axes.set(xlabel="t (s)", ylabel="z (m)", title="Slides and slips, over the limit")


def draw_bracket(axes: Axes) -> None:
    """Two lanes, one from below and one from above, with the trajectory between."""
    begin, ask, end = 0.30, 0.52, 0.60

    def rate(t, z):
        pull = SCENE.load(t) - SCENE.support.force(z[0])
        return [float(pull - SCENE.potential.force(z[0], EPS)) / EPS**GAMMA]

    t = np.linspace(begin, end, 601)
    run = np.asarray(fx.solve(SCENE, EPS, GAMMA, np.append(0.0, t)).z)[1:]
    axes.plot(t, run, color=LIMIT, lw=3, alpha=0.3)
    offsets = -2.2 * EPS, 0.9 * EPS
    for n, (name, offset) in enumerate(zip(("behind", "ahead"), offsets, strict=True)):
        found = solve_ivp(
            rate, (begin, end), [run[0] + offset], "LSODA", t, rtol=1e-9, atol=1e-12
        )
        axes.plot(t, found.y[0], color=colour(1 + n), label=f"lane {name}")
        axes.plot(begin, run[0] + offset, "o", color=colour(1 + n))
    axes.axvline(ask, color=LIMIT, lw=0.8, ls=":")
    at = ask, np.interp(ask, t, run)
    say(
        axes,
        "closed: both lanes agree,\nso does what is between",
        at,
        (0.49, run[0] - 0.09),
    )
    axes.plot([], [], color=LIMIT, lw=3, alpha=0.3, label="the trajectory")
    axes.legend(loc="upper left")
    axes.set(xlabel="t (s)", ylabel="z (m)", title="A bracket: solutions never cross")


@styled
def draw():
    figure, grid = new_figure(1, 3, 13.5, 4.2)
    draw_wells(grid[0, 0])
    draw_slides(grid[0, 1])
    draw_bracket(grid[0, 2])
    return figure


if __name__ == "__main__":
    draw().savefig(TARGET, dpi=110)
