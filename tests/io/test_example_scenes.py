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


def made(table, name):
    """A kind of part, and arguments that it takes."""
    if table == "effects":
        given = {"offsets": [0.0, 0.5], "weights": [1.0, 2.0], "bending_stiffness": 0.1}
        given |= {"temperature": 1e-3, "mass": 1.0, "exponent": 2.0}
    else:
        given = {
            "profile": {"slope": 0.1, "cos": [0.01, 0.0], "sin": [0.0, 0.01]}
            | {"slope_error": [0.0, 0.1], "slope_taken": [0.1, 0.0], "radius": 0.01}
            | {"x": [0.0, 0.3, 0.4, 0.7], "heights": [0.0, 0.1, 0.0, 0.05]},
            "bristle": {"a": 0.5, "alpha": 1.0, "stiffness": 1.0, "rest_length": 2.0}
            | {"length": 1.4, "height": 1.0, "angle": 0.5, "rest_angle": 0.3},
            "support": {"stiffness": 1.0},
            "load": {"rate": 1.0, "start": 0.1, "amplitude": 1.0, "period": 3.0}
            | {"times": [0.0, 1.0], "values": [0.0, 1.0]}
            | {"position": fx.loads.Ramp(1.0), "rest_length": 0.1},
        }[table]
    kind = (PARTS | {"effects": EFFECTS})[table][name]
    return kind, {field: given[field] for field in asked_names(kind, {})}


FIELDS = [
    (table, name, field)
    for table, kinds in (*PARTS.items(), ("effects", EFFECTS))
    for name, kind in kinds.items()
    for field in asked_names(kind, {})
]
REFUSED = {
    "> 0": [0.0, -1.0],
    "not 0": [0.0],
    "> height": [1.0],
    "in (-pi/2, pi/2)": [-1.6, 1.6],
    "in (-pi/2, arccos(height/length))": [-1.6, 0.8],
    "increasing": [[0.3, 0.2, 0.5, 0.6]],
    "in [0, 1)": [[0.0, 0.3, 0.4, 1.2], [-0.1, 0.3, 0.4, 0.7]],
    "not all equal": [[0.1] * 4],
    "4 or more": [[0.0, 0.1, 0.0]],
    "2 or more": [[0.0]],
    "as long as": [[0.0, 0.1, 0.3]],
    "corners do not overlap": [10.0],
    "two numbers >= 0": [[0.1], [-0.1, 0.1]],
    "not all 0": [[0.0, 0.0]],
    ">= 0, not all 0": [[1.0, -1.0]],
    "a table": [1.0],
}
TAKEN = {"> 0": [1e-3], "not 0": [-0.1], "any": [0.0, -3.0], "in (-pi/2": [-1.5]}


@pytest.mark.parametrize(("table", "name", "field"), FIELDS)
def test_a_field_is_told_with_its_unit_and_what_its_part_allows(table, name, field):
    kind, given = made(table, name)
    unit, allowed, row = kind.asked[field]
    end = "]]" if table == "effects" else "]"
    line = next(
        text
        for text in schema_text().split(f'{table}{end} kind = "{name}"\n')[1].splitlines()
        if text.split()[:1] == [field]
    )
    assert f"  {unit}, {allowed}" in line
    if "not all 0 in both" in allowed:
        given["sin"] = [0.0, 0.0]
    kind(**given)
    for words, values in TAKEN.items():
        for value in values if words in allowed and not row else ():
            kind(**(given | {field: value}))
    wrong = [v for words, values in REFUSED.items() if words in allowed for v in values]
    if field != "position":
        wrong += [float("nan"), [[1.0], [2.0]]] + ([1.0] if row else [[1.0, 2.0]])
    for value in wrong:
        with pytest.raises(ValueError, match=field if field != "sin" else "sin|cos"):
            kind(**(given | {field: value}))


def test_units_are_those_of_the_classes():
    for kinds in (*PARTS.values(), EFFECTS):
        for kind in kinds.values():
            assert list(kind.asked) == asked_names(kind, {})
            said = " ".join((kind.__doc__ or "").split())
            for field, asked in kind.asked.items():
                unit = "" if asked.unit == "no unit" else asked.unit
                assert f"`{field}`" in said, (kind, field)
                assert unit in said, (kind, field, unit)
