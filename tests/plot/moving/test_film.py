"""A moving picture shows as many times as asked for, each as `mechanics` has it."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from drawn_bristles import line, pulled_scene
from matplotlib.animation import FuncAnimation
from matplotlib.figure import Figure
from PIL import Image, ImageChops
from rods_that_turn import ROD, SURFACE, turning_scene

import frictionjax as fx
from frictionjax.plot.moving.force_course import ForceCourse

T = np.linspace(0, 4, 401)


@pytest.fixture(scope="module")
def slid():
    scene = pulled_scene("rod")
    return scene, fx.solve_limit(scene, T)


def watched(scene, solution, eps=None, **options):
    """Drawn frame by frame, as no one else will: or it would warn that nobody saw it."""
    film = fx.plot.animate(scene, solution, eps, dpi=40, **options)
    film._draw_was_started = True
    return film


def saved(film, path):
    """Size of a GIF, how long its frames are shown in ms, and the frames."""
    film.save(path, writer="pillow")
    with Image.open(path) as gif:
        frames = []
        for index in range(gif.n_frames):
            gif.seek(index)
            frames.append(gif.convert("RGB"))
        return gif.size, gif.info["duration"], frames


def test_a_gif_holds_every_frame_and_they_differ(slid, tmp_path):
    film = fx.plot.animate(*slid, frames=5, interval=100, dpi=40)
    assert isinstance(film, FuncAnimation)
    size, duration, frames = saved(film, tmp_path / "slid.gif")
    assert (size, duration, len(frames)) == ((384, 192), 100, 5)
    for one, other in pairwise(frames):
        assert ImageChops.difference(one, other).getbbox() is not None


def test_what_is_shown_is_the_solution(slid):
    scene, limit = slid
    data = fx.mechanics(scene, limit)
    film = watched(scene, limit, frames=401, against="tip")
    axes, force = film._fig.axes
    for row in (130, 400):
        film._draw_frame(row)
        now = data.isel(time=row)
        assert line(axes, "root u")[0, 0] == pytest.approx(float(now.u))
        assert f"t = {T[row]:.4g} s" in axes.get_title(loc="left")
        whole, gone, marked = (np.asarray(one.get_data()) for one in force.lines[:3])
        np.testing.assert_array_equal(whole, [data.p, data.support_force])
        np.testing.assert_array_equal(gone, whole[:, : row + 1])
        np.testing.assert_array_equal(marked[:, 0], [now.p, now.support_force])
    law = fx.friction(scene)
    levels = [one.get_ydata()[0] for one in force.lines[3:]]
    assert levels == pytest.approx([float(law.rho_plus), float(law.rho_minus)])
    assert (force.get_xlabel(), axes.get_xlabel()) == ("tip p (m)", "x (m)")


def test_a_rod_that_turns_over_has_its_own_levels():
    scene = turning_scene()
    film = watched(scene, fx.solve_limit(scene, T), frames=9)
    force = film._fig.axes[-1]
    law = fx.nap(SURFACE, ROD)
    levels = [one.get_ydata()[0] for one in force.lines[3:]]
    assert levels == pytest.approx([law.rho_with, -law.rho_flipped])
    bent = 0
    for frame in range(9):
        film._draw_frame(frame)
        bent += "chord" in film._fig.axes[0].get_title(loc="left")
    assert bent >= 2


@pytest.mark.parametrize(
    ("eps", "drag", "told"), [(0.1, 1.25, True), (0.1, 1.15, False), (None, 1.25, False)]
)
def test_levels_are_said_to_be_the_limits_where_drag_goes_beyond_them(eps, drag, told):
    scene = pulled_scene("rod")
    force = drag * np.array([0.0, 1.0, 0.0]) * float(fx.friction(scene).rho_plus)
    places = SimpleNamespace(
        eps=eps, time=np.arange(3.0), tip=np.zeros((3, 1)), force=force
    )
    axes = Figure().add_subplot()
    ForceCourse(axes, scene, places, "time")
    assert ("without drag" in axes.get_title(loc="left") + axes.get_title()) == told


@pytest.mark.slow  # rods that turn over, at an eps
def test_at_finite_eps_the_tip_is_close_up_and_all_of_it_is_in_view(tmp_path):
    scene, eps = turning_scene(duration=3.0), 0.08
    found = fx.solve(scene, eps, 1.0, np.linspace(0, 3, 301))
    film = fx.plot.animate(scene, found, eps, frames=4, dpi=40)
    axes, close, _ = film._fig.axes
    assert close.get_title(loc="left") == "Its tip, heights stretched"
    for frame in range(4):
        film._draw_frame(frame)
        low, high = axes.get_xlim()
        assert low < np.min(line(axes, "bristle")[0])
        assert high > np.max(line(axes, "bristle")[0])
    assert len(saved(film, tmp_path / "turned.gif")[2]) == 4


def test_what_does_not_fit_is_refused(slid):
    for name, value, needs in (
        ("frames", 1, "a whole number >= 2"),
        ("against", "place", "one of time, tip"),
        ("interval", 0.0, "one number > 0"),
        ("dpi", -1.0, "one number > 0"),
    ):
        with pytest.raises(ValueError, match=rf"{name} = .*: needs {needs}"):
            fx.plot.animate(*slid, **{name: value})
    scene, _ = slid
    with pytest.raises(ValueError, match="at least two to move between"):
        fx.plot.animate(scene, fx.solve_limit(scene, [0.0]))
    array = scene.replace(effects=(fx.effects.RigidArray([0.0, 0.4]),))
    with pytest.raises(ValueError, match="RigidArray"):
        fx.plot.animate(array, slid[1])
