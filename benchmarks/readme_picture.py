"""Pictures of the README: what a bristle is, and what friction comes out of it.

Writes frictionjax/overview.png, of the scene that is built in, gamma = 1; with `--movie`
frictionjax/sliding.gif instead, the same bristle as it slides to and fro.
"""

import argparse
import tempfile
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from matplotlib.axes import Axes
from PIL import Image, ImageSequence

import frictionjax as fx
from frictionjax.plot.style import GUIDE, LIMIT, colour, new_figure, styled

TARGET = Path(__file__).parents[1] / "frictionjax" / "overview.png"
MOVIE = TARGET.with_name("sliding.gif")
EPS = (0.03, 0.01)
# Few slips, which can be told apart, at a gamma with little drag.
MOVIE_EPS, MOVIE_GAMMA, FRAMES, COLOURS = 0.08, 2.0, 64, 48
jax.config.update("jax_enable_x64", True)
fx.use_fast_cpu()
SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.0488, 3.0),
    3.0,
)
PERIOD, HEIGHT = 0.5, 4.0  # of the wiggles in the sketch, which exaggerates their heights
LEAN, TIP = 0.55, 1.0  # rad; a place


def coil(start: np.ndarray, end: np.ndarray, turns: int = 9, width: float = 0.055):
    """A spring from start to end, as a zigzag, (points, 2)."""
    way = end - start
    along = np.concatenate([[0.0, 0.12], np.linspace(0.16, 0.84, 2 * turns), [0.88, 1.0]])
    side = np.concatenate([[0, 0], np.resize([1.0, -1.0], 2 * turns), [0, 0]]) * width
    across = np.array([-way[1], way[0]]) / np.hypot(*way)
    return start + along[:, None] * way + side[:, None] * across


def draw_sketch(axes: Axes) -> None:
    """A bristle on its surface, and what its parts are called."""
    x = np.linspace(0.0, 3.45, 801)
    surface = HEIGHT * PERIOD * np.asarray(SCENE.profile(x / PERIOD))
    axes.fill_between(x, surface, -0.3, color=GUIDE, alpha=0.5, lw=0)
    axes.plot(x, surface, color=LIMIT, lw=1.2)
    tip = np.array([TIP, HEIGHT * PERIOD * float(SCENE.profile(TIP / PERIOD))])
    root = tip + np.array([np.tan(LEAN), 1.0])
    post = root + np.array([1.25, 0.0])
    axes.plot(*coil(tip, root).T, color=colour(0), lw=1.8)
    axes.plot(*coil(root, post).T, color=LIMIT, lw=1.2)
    axes.plot(*root, "s", color=colour(0), ms=8)
    axes.plot(*tip, "o", color=colour(0), ms=6)
    axes.plot([post[0]] * 2, post[1] + np.array([-0.09, 0.09]), color=LIMIT, lw=3)
    axes.plot([root[0]] * 2, [root[1], root[1] - 0.62], ":", color=LIMIT, lw=1)
    turn = np.pi * 1.5 - np.linspace(0.0, LEAN, 30)
    arc = root[:, None] + 0.5 * np.array([np.cos(turn), np.sin(turn)])
    axes.plot(*arc, color=LIMIT, lw=1)
    say: dict[str, Any] = {"fontsize": 9.5, "ha": "center", "va": "center"}
    axes.text(root[0] + 0.36, root[1] - 0.42, "angle > 0", **say)
    axes.text(tip[0] - 0.22, tip[1] + 0.13, "tip", **say)
    axes.text(root[0] - 0.03, root[1] + 0.15, "root", **say)
    axes.text(tip[0] - 0.02, tip[1] + 0.6, "bristle", color=colour(0), **say)
    axes.text(root[0] + 0.62, root[1] + 0.17, "support", **say)
    axes.text(2.4, 0.26, "surface $\\epsilon\\, w(x/\\epsilon)$", **say)
    arrow = {"arrowstyle": "->", "lw": 1.4, "color": LIMIT}
    axes.annotate("", (post[0] + 0.42, post[1]), (post[0], post[1]), arrowprops=arrow)
    axes.text(post[0] + 0.22, post[1] + 0.15, "load", **say)
    axes.annotate("", (0.62, 1.5), (0.1, 1.5), arrowprops=arrow)
    axes.text(0.36, 1.62, "right: +", **say)
    low = HEIGHT * PERIOD * -0.1 / (2 * np.pi) - 0.06
    axes.annotate(
        "",
        (2.625, low),
        (2.125, low),
        arrowprops={"arrowstyle": "<->", "lw": 1, "color": LIMIT},
    )
    axes.text(2.375, low - 0.1, "$\\epsilon$", **say)
    axes.set(
        xlim=(0.0, 3.45), ylim=(-0.3, 1.75), aspect="equal", title="A bristle, dragged"
    )
    axes.set_axis_off()


def draw_forces(axes: Axes) -> None:
    """Friction of the wiggly system, and of its limit, over one load cycle."""
    ts = np.linspace(0.0, 3.0, 6001)
    load = np.asarray(jax.vmap(SCENE.load)(jnp.asarray(ts)))
    limit = np.asarray(fx.solve_limit(SCENE, ts).z)
    for index, eps in enumerate(EPS):
        z = np.asarray(fx.solve(SCENE, eps, 1.0, ts, method="resolved").z)
        label = f"$\\epsilon$ = {eps:g} m"
        axes.plot(z, load - z, color=colour(index), lw=0.9, label=label)
    axes.plot(limit, load - limit, "--", color=LIMIT, lw=1.6, label="limit: dry friction")
    law = fx.friction(SCENE)
    for value, name in ((law.rho_plus, "\\rho_+"), (law.rho_minus, "\\rho_-")):
        axes.text(0.25, 0.8 * float(value), f"${name}$ = {value:.3f} N", va="center")
    axes.set(xlabel="z (m)", ylabel="friction force (N)", ylim=(-0.155, 0.175))
    axes.set_title("What holds it, to and fro")
    axes.legend(loc="center left", bbox_to_anchor=(0.12, 0.5), fontsize=9)


def draw_errors(axes: Axes) -> None:
    """How far the wiggly system is from its limit, over eps."""
    eps = np.geomspace(0.1, 1e-6, 13)
    data = fx.sweep(SCENE, eps, [0.75, 1.0])
    for index, gamma in enumerate((0.75, 1.0)):
        errors = data.sup_error.sel(gamma=gamma)
        label = f"$\\gamma$ = {gamma:g}"
        axes.loglog(eps, errors, "o", color=colour(index), ms=4, label=label)
    axes.loglog(eps, eps, "--", color=LIMIT, lw=1.2, label="one well: $\\epsilon$")
    axes.set(xlabel="$\\epsilon$ (m)", ylabel="sup$_t$ |z$_\\epsilon$ - z| (m)")
    axes.set_title("How fast the limit is reached")
    axes.legend(fontsize=9)


@styled
def overview():
    figure, grid = new_figure(1, 3, 13.5, 3.9)
    draw_sketch(grid[0, 0])
    draw_forces(grid[0, 1])
    draw_errors(grid[0, 2])
    return figure


def write_movie() -> None:
    """A GIF of few colours, the same ones in all frames, so that it is small."""
    ts = np.linspace(0.0, 3.0, 4001)
    found = fx.solve(SCENE, MOVIE_EPS, MOVIE_GAMMA, ts, method="resolved")
    film = fx.plot.animate(SCENE, found, MOVIE_EPS, frames=FRAMES, interval=90, dpi=66)
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder) / "whole.gif"
        film.save(whole, writer="pillow")
        with Image.open(whole) as image:
            frames = [one.convert("RGB") for one in ImageSequence.Iterator(image)]
    # By coverage: by median cut the tip's orange was grey.
    palette = frames[FRAMES // 2].quantize(COLOURS, Image.Quantize.MAXCOVERAGE)
    few = [one.quantize(palette=palette, dither=Image.Dither.NONE) for one in frames]
    look: dict[str, Any] = {"duration": 90, "loop": 0, "optimize": True}
    few[0].save(MOVIE, save_all=True, append_images=few[1:], **look)
    print(f"{MOVIE.name}: {len(few)} frames, {MOVIE.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--movie", action="store_true", help="the moving one instead")
    if parser.parse_args().movie:
        write_movie()
    else:
        overview().savefig(TARGET, dpi=90, facecolor="white")
