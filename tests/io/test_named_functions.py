"""Scene files that name functions of Python: read where that is allowed, and written."""

import sys

import jax.numpy as jnp
import numpy as np
import pytest
from command_line import error_line, run

import frictionjax as fx

MODULE = """
import jax.numpy as jnp

def surface(y):
    return 0.02 * jnp.exp(jnp.cos(2 * jnp.pi * y))

def offset(eta):
    return -1.5 * eta

def energy(eta):
    return jnp.exp(eta)

def support(z):
    return z**2 / 2 + z**4

def load(t):
    return jnp.sin(2 * t)

def W(Y):
    return 0.02 * jnp.sin(2 * jnp.pi * Y)

def Q(eps, Y):
    return 0.1 * jnp.cos(2 * jnp.pi * Y)

class inner:
    def fn(y):
        return surface(y)

number = 3.0
"""
BRISTLE = """
duration = 2.0
[profile]
kind = "Custom"
fn = "{module}:surface"
points = 512
[bristle]
kind = "Custom"
offset = "{module}:offset"
energy = "{module}:energy"
[support]
kind = "Convex"
energy = "{module}:support"
[load]
kind = "Custom"
fn = "{module}:load"
"""
GIVEN = """
duration = 2.0
[potential]
kind = "GivenPotential"
W = "{module}:W"
Q = "{module}:Q"
[support]
kind = "Spring"
stiffness = 1.0
[load]
kind = "Sine"
amplitude = 1.0
period = 2.0
"""


@pytest.fixture
def files(tmp_path, request):
    """A folder with a module and scene files that name its functions."""
    module = f"parts_of_{abs(hash(request.node.nodeid)):x}"
    (tmp_path / f"{module}.py").write_text(MODULE)
    for name, text in (("bristle", BRISTLE), ("given", GIVEN)):
        (tmp_path / f"{name}.toml").write_text(text.format(module=module))
    yield tmp_path, module
    sys.modules.pop(module, None)


def by_hand():
    return fx.Scene(
        fx.profiles.Custom(lambda y: 0.02 * jnp.exp(jnp.cos(2 * jnp.pi * y)), points=512),
        fx.bristles.Custom(lambda eta: -1.5 * eta, jnp.exp),
        fx.supports.Convex(lambda z: z**2 / 2 + z**4),
        fx.loads.Custom(lambda t: jnp.sin(2 * t)),
        2.0,
    )


def test_functions_are_imported_where_that_is_allowed(files):
    folder, module = files
    before = list(sys.path)
    scene = fx.load_scene(folder / "bristle.toml", functions=True)
    assert sys.path == before
    assert scene.profile.points == 512
    ts = np.linspace(0, 2, 9)
    found, expected = (fx.solve_limit(s, ts).z for s in (scene, by_hand()))
    np.testing.assert_array_equal(found, expected)
    assert float(fx.friction(scene).rho_plus) == float(fx.friction(by_hand()).rho_plus)
    given = fx.load_scene(folder / "given.toml", functions=True)
    assert float(given.potential.Q(1e-3, 0.0)) == pytest.approx(0.1)
    assert module in sys.modules


def test_nothing_is_imported_where_it_is_not(files):
    folder, module = files
    for name in ("bristle", "given"):
        with pytest.raises(ValueError, match="functions=True") as told:
            fx.load_scene(folder / f"{name}.toml")
        assert f"{module}:" in str(told.value)
    assert module not in sys.modules


def test_what_is_written_reads_back(files, tmp_path):
    folder, module = files
    for name in ("bristle", "given"):
        one = fx.load_scene(folder / f"{name}.toml", functions=True)
        fx.save_scene(one, folder / "again.toml", {"eps": [0.1], "gamma": [1.0]})
        text = (folder / "again.toml").read_text()
        assert f'"{module}:' in text
        again = fx.load_scene(folder / "again.toml", functions=True)
        assert repr(one) == repr(again)
        assert float(fx.friction(one).rho_plus) == float(fx.friction(again).rho_plus)


def test_functions_without_a_name_are_not_written(tmp_path):
    with pytest.raises(ValueError, match=r"scene.profile = .*by name: fn is none"):
        fx.save_scene(by_hand(), tmp_path / "scene.toml")


def test_numbers_of_loads_are_kept(files):
    folder, _ = files
    text = (folder / "bristle.toml").read_text()
    (folder / "listed.toml").write_text(f"{text}turning_points = [{np.pi / 4}]\n")
    one = fx.load_scene(folder / "listed.toml", functions=True)
    fx.save_scene(one, folder / "again.toml")
    again = fx.load_scene(folder / "again.toml", functions=True)
    np.testing.assert_array_equal(one.load.listed, again.load.listed)
    assert np.size(again.load.listed) == 1


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("{module}:surface", "{module}:nothing", "a name that"),
        ("{module}:surface", "{module}:number", "needs a function"),
        ("{module}:surface", "no_such_module_at_all:fn", "ModuleNotFoundError"),
        ("{module}:surface", "surface", "module:function"),
        ('"{module}:surface"', "3", "module:function"),
        ("points = 512", "points = 0.5", "a whole number"),
        ("points = 512", "pints = 512", "pints is unknown"),
        ('offset = "{module}:offset"', "", "offset is missing"),
        ('kind = "Convex"', 'kind = "Concave"', "one of Spring, Convex"),
        (
            "{module}:surface",
            "{module}:Q",
            "a function of y alone",
        ),
    ],
)
def test_mistakes_are_named_on_one_line(files, old, new, told):
    folder, module = files
    text = (folder / "bristle.toml").read_text()
    changed = text.replace(old.format(module=module), new.format(module=module))
    assert changed != text
    (folder / "wrong.toml").write_text(changed)
    with pytest.raises(ValueError, match=told) as error:
        fx.load_scene(folder / "wrong.toml", functions=True)
    assert "\n" not in str(error.value)
    assert "wrong.toml" in str(error.value)


@pytest.mark.parametrize(
    ("name", "code", "told"),
    [
        ("broken", "1 / 0", "ZeroDivisionError: division by zero"),
        ("leaving", "import sys; sys.exit(3)", "SystemExit: 3"),
    ],
)
def test_modules_that_fail_are_told(files, name, code, told):
    folder, module = files
    (folder / f"{name}_parts.py").write_text(code)
    text = (folder / "given.toml").read_text().replace(f"{module}:W", f"{name}_parts:W")
    (folder / f"{name}.toml").write_text(text)
    with pytest.raises(ValueError, match=told):
        fx.load_scene(folder / f"{name}.toml", functions=True)


def test_names_inside_names(files):
    folder, module = files
    text = (folder / "bristle.toml").read_text()
    (folder / "inner.toml").write_text(text.replace(":surface", ":inner.fn"))
    scene = fx.load_scene(folder / "inner.toml", functions=True)
    fx.save_scene(scene, folder / "again.toml")
    assert f"{module}:inner.fn" in (folder / "again.toml").read_text()


def test_commands_import_functions_when_told(files):
    folder, module = files
    refused = error_line(run("friction", folder / "bristle.toml"))
    assert "--functions" in refused
    assert module not in sys.modules
    told = run("friction", folder / "bristle.toml", "--functions")
    assert told.exit_code == 0, told.stderr
    assert f"{float(fx.friction(by_hand()).rho_plus):.6g}" in told.stdout
    given = error_line(run("friction", folder / "given.toml", "--functions"))
    assert "[potential]" in given


@pytest.mark.slow  # 18 s: parts that the suite does not know
def test_a_study_of_functions_leaves_a_scene_that_reads_back(files):
    folder, _ = files
    made = folder / "study"
    options = "--eps", "0.1,0.03", "--gamma", "1", "--no-progress", "--functions"
    told = run("study", folder / "bristle.toml", *options, "--out", made)
    assert told.exit_code == 0, told.stderr
    again = fx.load_scene(made / "scene.toml", functions=True)
    assert repr(again) == repr(fx.load_scene(folder / "bristle.toml", functions=True))
