"""Pictures of a rod that turns over hold what they claim to."""

import io

import numpy as np
import pytest
from rods_that_turn import REACH, ROD, SURFACE, jumping_scene, turning_scene

import frictionjax as fx

LETTERS = "abcdefg"


def drawn(figure):
    figure.savefig(io.BytesIO(), format="png", dpi=40)
    return figure.axes


def titles(axes):
    return [one.get_title(loc="left")[3:] for one in axes]


def picture(scene, **kwargs):
    return drawn(fx.plot.draw_turning(scene, fx.solve_limit(scene), **kwargs))


@pytest.mark.parametrize("scene", [turning_scene(), jumping_scene()], ids=["led", "jumps"])
def test_every_phase_is_drawn_in_its_order(scene):
    *strip, way, force = picture(scene)
    assert titles(strip) == [
        "slides with nap",
        "held against it",
        "critical load",
        *3 * ["bent over its tip"],
        "turned over",
    ]
    marks = [t for t in way.texts if t.get_text() in LETTERS]
    assert [m.get_text() for m in marks] == list(LETTERS)
    times = [mark.xy[0] for mark in marks]
    assert times == sorted(times)
    assert way.get_ylabel() == "place (m)"
    assert force.get_xlabel() == "t (s)"


def rods_of(strip):
    return [np.asarray(axes.lines[1].get_data()) for axes in strip]


def test_rods_are_as_long_as_they_are_and_bent_over_one_tip():
    *strip, _, _ = picture(turning_scene())
    rods = rods_of(strip)
    for points in rods:
        assert np.sum(np.hypot(*np.diff(points))) == pytest.approx(2**0.5, rel=1e-3)
        np.testing.assert_allclose(points[:, 0], 0, atol=1e-12)
        assert points[1, -1] == pytest.approx(1.0)
        assert np.min(points[1]) >= -1e-12
    ends = [points[0, -1] / REACH for points in rods]
    np.testing.assert_allclose(ends, [1, 1, 1, 0.5, 0, -0.5, -1], atol=1e-9)
    # The root goes to the left, and there the rod is bent.
    middle = rods[4][0, 50]
    assert middle < -0.3
    straight = rods[0]
    np.testing.assert_allclose(straight[0], straight[1], atol=1e-6)


def test_what_is_below_is_the_solutions():
    scene = turning_scene()
    limit = fx.solve_limit(scene)
    *_, way, force = drawn(fx.plot.draw_turning(scene, limit))
    np.testing.assert_array_equal(way.lines[0].get_ydata(), limit.root)
    np.testing.assert_array_equal(way.lines[1].get_ydata(), limit.tip)
    pull = np.asarray([scene.load(t) for t in limit.ts]) - np.asarray(limit.z)
    np.testing.assert_allclose(force.lines[0].get_ydata(), pull, atol=1e-9)
    law = fx.nap(SURFACE, ROD)
    levels = [line.get_ydata()[0] for line in force.lines[1:3]]
    assert levels == pytest.approx([law.rho_with, -law.rho_flipped])


def test_at_finite_eps_the_surface_is_wiggly():
    scene, eps = turning_scene(duration=3.0), 0.08
    found = fx.solve(scene, eps, 1.0, np.linspace(0, 3, 301))
    *strip, _, _ = drawn(fx.plot.draw_turning(scene, found, eps))
    assert len(strip) == 7
    heights = strip[0].lines[0].get_ydata()
    assert np.ptp(heights) == pytest.approx(eps * 0.5 / np.pi, rel=1e-2)


def test_what_does_not_turn_is_refused():
    with pytest.raises(ValueError, match="one in which the rod turns over"):
        picture(turning_scene(amplitude=0.1))
    plain = turning_scene().replace(effects=())
    with pytest.raises(ValueError, match=r"scene\.effects = .none of NapFlip"):
        fx.plot.draw_turning(plain, fx.solve_limit(plain))


def test_loops_of_both_effects_are_beside_each_other():
    scene = turning_scene()
    stiff, bent = drawn(fx.plot.draw_nap_loops(scene))
    law = fx.nap(SURFACE, ROD)
    force = stiff.lines[0].get_ydata()
    assert np.nanmin(force) == pytest.approx(-law.rho_against)
    assert np.nanmax(force) == pytest.approx(law.rho_with)
    assert np.nanmax(bent.lines[0].get_ydata()) == pytest.approx(law.rho_with)
    slides = np.isclose(bent.lines[0].get_ydata(), -law.rho_flipped)
    assert slides.sum() > 10
    assert stiff.get_ylim() == bent.get_ylim()
    assert "geometric" in stiff.get_title(loc="left").lower()


def test_labels_of_levels_are_beside_what_goes_beyond_them():
    """A rod that is bent over its tip pulls more than it does as it slides."""
    figure = fx.plot.draw_nap_loops(turning_scene())
    figure.draw_without_rendering()
    axes = figure.axes[1]
    label = axes.texts[1]
    box = label.get_window_extent().transformed(axes.transData.inverted())
    z, force = np.asarray(axes.lines[1].get_data(), dtype=float)
    beyond = z[force < 1.01 * label.xy[1]]
    room = 0.1 * box.width
    assert beyond.size > 10
    assert not np.any((beyond > box.x0 - room) & (beyond < box.x1 + room))
