"""A bristle is drawn where `mechanics` has it."""

import jax.numpy as jnp
import numpy as np
import pytest
from drawn_bristles import line, pulled_scene, rendered
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from rods_that_turn import ROD, SURFACE, turning_scene

import frictionjax as fx

T = np.linspace(0, 4, 401)
EPS = 0.08


def wedge(axes):
    (found,) = (one for one in axes.patches if isinstance(one, Polygon))
    return found


@pytest.mark.parametrize("kind", ["rod", "slanted", "vertical", "bead"])
def test_root_tip_and_far_end_are_where_mechanics_has_them(kind):
    scene = pulled_scene(kind)
    limit = fx.solve_limit(scene, T)
    here = fx.mechanics(scene, limit).sel(time=2.33, method="nearest")
    figure = fx.plot.draw_bristle(scene, limit, 2.332)
    (axes,) = rendered(figure)
    root, tip, far = (line(axes, name)[:, 0] for name in ("root u", "tip p", "end q"))
    np.testing.assert_allclose([root[0], tip[0], far[0]], [here.u, here.p, here.q])
    assert tip[1] == 0
    assert far[1] == root[1]
    spring = line(axes, "spring")
    np.testing.assert_allclose(spring[:, [0, -1]], np.stack([root, far], axis=1))
    bristle = line(axes, "link" if kind == "bead" else "bristle")
    np.testing.assert_allclose(bristle[:, [0, -1]], np.stack([tip, root], axis=1))
    if kind != "bead":
        assert np.hypot(*(root - tip)) == pytest.approx(float(here.length))
        assert root[1] == pytest.approx(1.0)
    coiled = np.ptp(bristle[0] - np.linspace(tip[0], root[0], bristle.shape[1])) > 1e-9
    assert coiled == (kind in ("slanted", "vertical"))
    assert "t = 2.33 s" in axes.get_title(loc="left")


def test_angles_are_positive_to_the_left_of_the_vertical():
    for kind, angle in (("rod", 0.25 * np.pi), ("slanted", -0.6)):
        scene = pulled_scene(kind)
        limit = fx.solve_limit(scene, T)
        (axes,) = rendered(fx.plot.draw_bristle(scene, limit, 1.0))
        root = line(axes, "root u")[:, 0]
        corners = wedge(axes).get_xy()[1:-1] - root  # without the root, twice
        seen = np.arctan2(-corners[:, 0], -corners[:, 1])
        assert seen[0] == pytest.approx(0, abs=1e-12)
        assert seen[-1] == pytest.approx(angle)
        assert f"{angle:+.3f} rad" in axes.get_title(loc="left")
        if kind == "rod":
            rest = line(axes, "$\\theta$ at rest")
            down = rest[:, 1] - rest[:, 0]
            assert np.arctan2(-down[0], -down[1]) == pytest.approx(0.3)


def test_names_of_both_ends_stand_apart_however_short_the_spring_is():
    rod, pull = fx.bristles.AngularSpring(1.0, 1.3, 1.0, 0.3), fx.loads.Sine(0.7, 4.0)
    scene = fx.Scene(fx.profiles.Sine(0.1), rod, fx.supports.Spring(2.0), pull, 4.0)
    limit = fx.solve_limit(scene, T)
    seen = fx.mechanics(scene, limit)
    ahead = (seen.q - seen.u).values
    shortest, behind = int(np.argmin(np.abs(ahead))), int(np.argmin(ahead))
    assert abs(ahead[shortest]) < 0.02
    assert ahead[behind] < 0
    for row in (shortest, behind):
        (axes,) = rendered(fx.plot.draw_bristle(scene, limit, T[row]))
        boxes = {one.get_text(): one.get_window_extent() for one in axes.texts}
        assert not boxes["u"].overlaps(boxes["q"])
        assert (boxes["q"].x0 > boxes["u"].x0) == (ahead[row] >= 0)


@pytest.fixture(scope="module")
def turned():
    scene = turning_scene(duration=3.0)
    return scene, fx.solve(scene, EPS, 1.0, np.linspace(0, 3, 301))


@pytest.mark.slow  # rods that turn over, at an eps
def test_a_rod_is_as_long_as_it_is_however_it_is_bent(turned):
    scene, found = turned
    data = fx.mechanics(scene, found, EPS)
    mode = data["mode"].values
    between = int(np.flatnonzero(mode == 0).mean())
    for row in (20, between, int(np.flatnonzero(mode == -1)[0])):
        figure = fx.plot.draw_bristle(scene, found, found.ts[row], EPS)
        axes, close = rendered(figure)
        rod = line(axes, "bristle")
        length = np.sum(np.hypot(*np.diff(rod)))
        assert length == pytest.approx(float(ROD.length), rel=1e-3)
        foot = EPS * float(SURFACE(data.p.values[row] / EPS))
        np.testing.assert_allclose(rod[:, 0], [data.p.values[row], foot], atol=1e-12)
        np.testing.assert_allclose(rod[:, -1], [data.u.values[row], 1.0])
        assert np.min(rod[1]) >= foot - 1e-12
        # Close up: the tip is on the surface, in units of eps.
        surface, line_of_rod, tip = (np.asarray(one.get_data()) for one in close.lines)
        assert tip[:, 0] == pytest.approx([0, foot / EPS])
        assert np.interp(0, *surface) == pytest.approx(foot / EPS, abs=1e-12)
        middle = (rod[:, 50 % rod.shape[1]] - [data.p.values[row], 0]) / EPS
        np.testing.assert_allclose(line_of_rod[:, 50 % rod.shape[1]], middle)
    assert mode[20] == 1


def test_a_bent_rod_leans_to_where_its_root_goes(turned):
    scene, found = turned
    row = int(np.flatnonzero(np.asarray(found.mode) == 0).mean())
    axes = rendered(fx.plot.draw_bristle(scene, found, found.ts[row], EPS))[0]
    rod = line(axes, "bristle")
    assert np.min(rod[0]) < np.min(rod[0, [0, -1]]) - 0.1
    assert "chord" in axes.get_title(loc="left")


def test_axes_of_ones_own():
    scene = pulled_scene("rod")
    mine = Figure().subplots(1, 2)
    drawn = fx.plot.draw_bristle(scene, fx.solve_limit(scene, T), 1.0, ax=mine[1])
    assert drawn is mine[1].figure
    assert line(mine[1], "bristle").shape == (2, 2)
    assert not mine[0].lines


def test_what_has_no_such_places_is_refused():
    scene = pulled_scene("rod")
    limit = fx.solve_limit(scene, T)
    given = fx.GivenPotential(lambda Y: jnp.sin(2 * jnp.pi * Y) / 60)
    load = fx.loads.Sine(1.0, 3.0)
    spring = fx.supports.Spring(1.0)
    abstract = fx.Scene(potential=given, support=spring, load=load, duration=3.0)
    with pytest.raises(ValueError, match=r"scene\.bristle = None: needs one: the abstract"):
        fx.plot.draw_bristle(abstract, limit, 1.0)
    for effect, name in (
        (fx.effects.RigidArray([0.0, 0.4]), "RigidArray"),
        (fx.effects.LeadingOrder(), "LeadingOrder"),
        (fx.effects.CompliantArray([0.0, 0.4]), "CompliantArray"),
    ):
        with pytest.raises(ValueError, match=rf"effects.*{name}.*a scene without it"):
            fx.plot.draw_bristle(scene.replace(effects=(effect,)), limit, 1.0)
    with pytest.raises(ValueError, match=r"time = 4\.1: needs a time in s from 0 to 4"):
        fx.plot.draw_bristle(scene, limit, 4.1)
    with pytest.raises(ValueError, match="ax = 'Figure': needs axes"):
        fx.plot.draw_bristle(scene, limit, 1.0, ax=Figure())
    with pytest.raises(ValueError, match=r"eps = 0\.1: needs None"):
        fx.plot.draw_bristle(scene, limit, 1.0, 0.1)
