"""Kinds of parts are listed once: scene files, JSON and designs know the same ones."""

import jax
import numpy as np
import pytest

import frictionjax as fx
from frictionjax import bristles, loads, profiles, supports
from frictionjax._checks.parts import Part, asked_names
from frictionjax.design.common.free_numbers import free_parameter
from frictionjax.io.registry import PARTS, numbers_of_part, part_entry, part_of

FOLDERS = {"profile": profiles, "bristle": bristles, "support": supports, "load": loads}
OF_FUNCTIONS = {"Custom", "Convex"}
SINE = profiles.Sine(0.1)
BRISTLES = [
    bristles.Homothetic(2.0),
    bristles.VerticalSpring(1.0, 2.0, 1.0),
    bristles.SlantedSpring(1.0, 2.4, 1.0, -0.5),
    bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3),
    bristles.Linear(-0.5, 2.0),
]
PROFILES = [
    SINE,
    profiles.Fourier([0.01, 0.0], [0.02, -0.003], [1e-4, 2e-4]),
    profiles.Spline(0.02 * np.sin(2 * np.pi * np.arange(8) / 8)),
    profiles.Polyline([0.0, 0.4], [0.0, 0.02], 0.3),
]
LOADS = [
    loads.Ramp(1.0),
    loads.Sine(1.0, 2.0),
    loads.Triangle(1.0, 2.0),
    loads.PiecewiseLinear([0.0, 1.0], [0.0, 2.0]),
    loads.Pulled(loads.Sine(1.0, 2.0), 0.4),
]


@pytest.mark.parametrize("table", PARTS)
def test_every_part_of_a_folder_is_listed_but_those_of_functions(table):
    """A new kind is added in one place, and not forgotten there."""
    parts = {
        name
        for name, kind in vars(FOLDERS[table]).items()
        if isinstance(kind, type) and issubclass(kind, Part) and "Abstract" not in name
    }
    assert set(PARTS[table]) == parts - OF_FUNCTIONS


@pytest.mark.parametrize("part", BRISTLES + PROFILES, ids=lambda p: type(p).__name__)
def test_an_entry_of_json_is_the_part(part):
    entry = part_entry(part)
    again = part_of(entry)
    assert type(again) is type(part)
    for name, value in numbers_of_part(part).items():
        np.testing.assert_allclose(getattr(again, name), value, rtol=0, atol=1e-16)
    assert set(entry) - {"kind"} <= set(asked_names(type(part), {}))


def test_all_kinds_are_tried_here():
    tried = {type(part) for part in [*BRISTLES, *PROFILES, *LOADS, supports.Spring(1.0)]}
    assert tried == {kind for kinds in PARTS.values() for kind in kinds.values()}


@pytest.mark.parametrize("load", LOADS, ids=lambda part: type(part).__name__)
def test_a_scene_file_has_every_number(load, tmp_path):
    for profile in PROFILES if load is LOADS[0] else [SINE]:
        scene = fx.Scene(profile, BRISTLES[1], supports.Spring(2.0), load, 1.0)
        fx.save_scene(scene, tmp_path / "scene.toml")
        again = fx.load_scene(tmp_path / "scene.toml")
        for table in PARTS:
            numbers = (jax.tree.leaves(getattr(s, table)) for s in (scene, again))
            for one, other in zip(*numbers, strict=True):
                np.testing.assert_allclose(other, one, rtol=0, atol=1e-16)


def test_parts_of_functions_leave_their_kind_alone():
    entry = part_entry(bristles.Custom(lambda eta: 0.1 * eta, lambda eta: eta))
    assert entry == {"kind": "Custom"}
    assert part_of(entry) is None


@pytest.mark.parametrize("bristle", BRISTLES, ids=lambda part: type(part).__name__)
def test_ranges_are_those_of_arguments(bristle):
    """What constructors refuse is what designs do not look for."""
    names = asked_names(type(bristle), {})
    assert {*bristle.positive, *bristle.angles} <= set(names)
    for name in names:
        low, high = free_parameter(bristle, name).own_range
        for end in (low, high):
            if np.isfinite(end):
                with pytest.raises(ValueError, match=rf"bristle\.{name}"):
                    bristle.replace(**{name: end + (1e-9 if end > 0 else -1e-9)})
