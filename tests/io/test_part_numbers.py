"""The numbers of a scene with their units."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax._checks import asked_names
from frictionjax.io import EFFECTS, PARTS, example_lines, example_text
from frictionjax.io.part_numbers import MEANINGS, part_rows, part_table, unit_of
from frictionjax.io.scene_files import default_study, load_study

KINDS = {kind for kinds in (*PARTS.values(), EFFECTS) for kind in kinds.values()}


@pytest.mark.parametrize("kind", sorted(KINDS, key=str), ids=lambda kind: kind.__name__)
def test_every_number_that_a_file_holds_has_a_unit_and_a_meaning(kind):
    known = MEANINGS[kind.__name__]
    assert set(asked_names(kind, {})) <= set(known)
    assert set(kind.asked) <= set(known)
    assert all(known.values())
    assert all(unit_of(kind, name) for name in asked_names(kind, {}))


def test_a_sine_is_a_surface_or_a_load():
    assert unit_of(fx.profiles.Sine(0.1), "slope") == "1"
    assert unit_of(fx.loads.Sine(1.0, 2.0), "amplitude") == "N"
    assert unit_of(fx.supports.Spring(1.0), "other") == ""


@pytest.mark.parametrize("name", sorted(example_lines()))
def test_scenes_that_ship_are_told_in_full(name, tmp_path):
    (tmp_path / "mine.toml").write_text(example_text(name))
    scene = load_study(tmp_path / "mine.toml").scene
    rows = part_rows(scene).rows
    told = {(part, number): value for part, _, number, value, _, _ in rows}
    assert float(told["scene", "duration"]) == pytest.approx(float(scene.duration))
    for part, kind, number, _, unit, _ in rows:
        assert unit or not number, (part, kind, number)
    assert {row[1] for row in rows if row[0] == "effect"} == {
        type(effect).__name__ for effect in scene.effects
    }


def test_a_load_read_as_a_place_is_in_metres():
    pulled = fx.loads.Pulled(fx.loads.Ramp(2.0))
    scene = fx.Scene(
        *(fx.profiles.Fourier(np.full(9, 1e-3), np.zeros(9)), fx.bristles.Homothetic(1.0)),
        *(fx.supports.Spring(1.0), pulled, 1.0),
    )
    rows = {(row[0], row[2]): row[3:5] for row in part_rows(scene).rows}
    assert rows["load, position", "rate"] == ("2", "m/s")
    assert rows["profile", "cos"] == ("9 values, 0.001 to 0.001", "periods")
    assert rows["profile", "sin"] == ("9 values, all 0", "periods")


def test_a_scene_tells_its_numbers_and_shows_them_in_a_notebook():
    scene = default_study().scene
    assert scene.table() == part_rows(scene)
    shown = scene._repr_html_()
    assert "<td" in shown
    assert "steepest slope of the surface" in shown
    traced = jax.jit(lambda one: isinstance(one._repr_html_(), str))
    assert traced(scene)
    with pytest.raises(ValueError, match="Scene = 'a trace': needs known"):
        jax.jit(lambda one: one.table().rows and 0.0)(scene)


def test_a_part_shows_its_numbers_in_a_notebook():
    lean = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
    shown = lean._repr_html_()
    for text in ("SlantedSpring", "angle", "0.5", "rad", "from the vertical"):
        assert text in shown
    whole = default_study().scene.replace(bristle=lean).potential
    assert {kind for kind, *_ in part_table(whole).rows} == {"Sine", "SlantedSpring"}
    assert ("SlantedSpring", "stiffness", "1", "N/m", "of the spring") in set(
        part_table(whole).rows
    )
    traced = jax.jit(lambda one: "SlantedSpring(" in one._repr_html_())
    assert traced(lean)
    assert "Custom" in fx.bristles.Custom(lambda e: 0 * e, lambda e: -e)._repr_html_()


def test_a_potential_that_is_given_is_told_by_name():
    given = fx.GivenPotential(W=lambda Y: 0.02 * jnp.sin(2 * jnp.pi * Y))
    known = default_study().scene
    bare = fx.Scene(potential=given, support=known.support, load=known.load, duration=3.0)
    kinds = {(part, kind) for part, kind, *_ in bare.table().rows}
    assert ("potential", "GivenPotential") in kinds
    assert not {part for part, _ in kinds} & {"profile", "bristle"}
