"""A trajectory is drawn as it is, over the strip and the limit of its own scene."""

import dataclasses

import numpy as np
import pytest
from rods_that_turn import turning_scene

import frictionjax as fx
from frictionjax._checks import note_origin, origin_of

SURFACE = fx.profiles.Sine(0.1)
BRISTLE = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
SCENE = fx.Scene(SURFACE, BRISTLE, fx.supports.Spring(1.0), fx.loads.Sine(1.0488, 3.0), 3.0)


def labelled(axes, start):
    return next(line for line in axes.lines if line.get_label().startswith(start))


def test_z_lies_over_its_strip_and_its_limit():
    ts = np.linspace(0.0, 3.0, 61)
    found = fx.solve(SCENE, 1e-2, 1.0, ts)
    (axes,) = found.plot().axes
    shown = labelled(axes, "z").get_data()
    np.testing.assert_array_equal(shown, [ts, found.z])
    at, limit = labelled(axes, "limit").get_data()
    np.testing.assert_allclose(limit, fx.solve_limit(SCENE, at).z, rtol=1e-12)
    assert at.size > 10 * ts.size
    law = fx.friction(SCENE)
    (strip,) = axes.collections
    corners = strip.get_paths()[0].vertices
    load = SCENE.load(np.asarray(3.0))
    last = np.unique(corners[corners[:, 0] == 3.0, 1])
    ends = float(load - law.rho_plus), float(load - law.rho_minus)
    assert last == pytest.approx(ends)
    assert axes.get_title(loc="left") == "Trajectory"


def test_slips_that_the_times_resolve_are_shown_as_slips():
    ts = np.linspace(0.0, 3.0, 3001)
    main, near = fx.solve(SCENE, 0.05, 1.0, ts).plot().axes
    assert len(main.patches) == 1
    begin, end = near.get_xlim()
    low, high = near.get_ylim()
    assert 3 * 0.05 < high - low < 8 * 0.05
    assert 0 < begin < end <= 3
    assert near.get_title(loc="left").startswith("A few slips")


def test_a_start_outside_the_strip_has_no_limit():
    scene = SCENE.replace(z0=0.5)
    (axes,) = fx.solve(scene, 1e-2, 1.0, np.linspace(0.0, 3.0, 4)).plot().axes
    assert [line.get_label() for line in axes.lines] == ["z"]


def test_of_a_rod_that_turns_over_its_root_is_drawn():
    found = fx.solve_limit(turning_scene())
    (axes,) = found.plot().axes
    np.testing.assert_array_equal(labelled(axes, "root").get_ydata(), found.root)
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert "bent over its tip" in labels


def test_a_failed_one_says_so():
    found = fx.solve(SCENE, 1e-2, 1.0, np.linspace(0.0, 3.0, 61))
    code = np.asarray(int(fx.Status.NOT_FINITE))
    bad = dataclasses.replace(found, status_code=code)
    note_origin(bad, origin_of(found))
    assert bad.plot().axes[0].get_title(loc="left") == bad.message
