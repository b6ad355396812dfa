"""Scenes that ship, and the list of fields that files may have."""

import inspect

import pytest

import frictionjax as fx
from frictionjax._checks import asked_names
from frictionjax.io import example_lines, example_text, load_study, schema_text
from frictionjax.io.registry import EFFECTS, PARTS


def test_every_line_says_something_else():
    lines = example_lines()
    assert len(set(lines.values())) == len(lines) >= 14
    assert all(20 < len(line) < 100 and "#" not in line for line in lines.values())


@pytest.mark.parametrize("name", example_lines())
def test_a_scene_is_read_and_has_friction(name, tmp_path):
    (tmp_path / "mine.toml").write_text(example_text(name), encoding="utf-8")
    scene, study = load_study(tmp_path / "mine.toml")
    law = fx.friction(scene)
    assert law.rho_plus > 0 > law.rho_minus
    assert set(study) == {"eps", "gamma", "accuracy"}
    # It slides both ways, and so shows what it is there for; a ramp pulls one way.
    limit = fx.solve_limit(scene.replace(effects=()) if name == "noise" else scene)
    moves = [float(limit.z.max() - limit.z[0]), float(limit.z.max() - limit.z[-1])]
    assert min(moves[: 1 if name == "prandtl-tomlinson" else 2]) > 20 * min(study["eps"])


def test_every_effect_that_files_know_has_a_scene():
    texts = [example_text(name) for name in example_lines()]
    for kind in EFFECTS:
        assert any(f'kind = "{kind}"' in text for text in texts), kind


def test_another_name_is_refused_with_those_that_there_are():
    with pytest.raises(ValueError, match=r"NAME = 'nap-flop': needs one of .* nap-flip"):
        example_text("nap-flop")
    with pytest.raises(ValueError, match="NAME"):
        example_text("../default_scene")


def test_the_schema_has_every_field_of_every_part():
    text = schema_text()
    for table, kinds in (*PARTS.items(), ("effects", EFFECTS)):
        for name, kind in kinds.items():
            heading = f'{table}]{"]" if table == "effects" else ""} kind = "{name}"'
            section = text.split(heading)[1].split("\n\n[")[0]
            for field in asked_names(kind, {}):
                assert f"\n  {field}" in section
            first = inspect.cleandoc(kind.__doc__).splitlines()[0]
            assert first in section
    assert ">>>" not in text  # a scene file holds no Python
