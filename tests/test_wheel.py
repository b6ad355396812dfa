"""The wheel: what it holds, and that all the README says runs from it alone."""

import re
import shutil
import sys
from email.parser import Parser
from pathlib import PurePath
from zipfile import ZipFile

import numpy as np
import pytest
from installed import Installed, built, python_named, skip_without_index
from packaging.specifiers import SpecifierSet
from readme import HOME, README, require_what_ten_lines_print, shell_lines, ten_lines

from frictionjax.cli import main

SHIPPED = {".py", ".pyi", ".toml", ".css", ".js", ".typed"}
LEFT_OUT = {".md", ".png", ".gif", ".pyc"}
BESIDE = {"METADATA", "WHEEL", "RECORD", "entry_points.txt", "licenses/LICENSE"}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    return built(tmp_path_factory.mktemp("wheel"))


def test_the_wheel_holds_the_library_and_nothing_else(wheel):
    """No page, no picture, no test; a file of another kind has to be decided on."""
    files = {
        str(path.relative_to(HOME))
        for path in (HOME / "frictionjax").rglob("*")
        if path.is_file() and path.suffix not in LEFT_OUT
    }
    assert {PurePath(file).suffix for file in files} == SHIPPED
    held = set(ZipFile(wheel).namelist())
    beside = {name for name in held if ".dist-info/" in name}
    assert held - beside == files
    assert {name.split(".dist-info/")[1] for name in beside} == BESIDE


def test_scenes_faces_and_types_are_in_the_wheel(wheel):
    held = set(ZipFile(wheel).namelist())
    assert {"frictionjax/py.typed", "frictionjax/__init__.pyi"} <= held
    packages = {name.rpartition("/")[0] for name in held if name.endswith("/__init__.py")}
    faces = {name.rpartition("/")[0] for name in held if name.endswith("/__init__.pyi")}
    assert len(faces) > 20
    assert faces <= packages
    scenes = {PurePath(name).stem for name in held if "/io/examples/" in name}
    assert len(scenes) > 10
    grooves = ZipFile(wheel).read("frictionjax/io/examples/measured-groove.toml").decode()
    assert "\ncos = [0.0095751, " in grooves


def metadata(wheel):
    (name,) = (n for n in ZipFile(wheel).namelist() if n.endswith("dist-info/METADATA"))
    return Parser().parsestr(ZipFile(wheel).read(name).decode())


def test_the_wheel_says_what_it_needs(wheel):
    said = metadata(wheel)
    assert said["Name"] == "frictionjax"
    assert said["License-Expression"] == "MIT"
    assert said.get_payload() == README.read_text()
    needed = [text for text in said.get_all("Requires-Dist") if "extra ==" not in text]
    assert len(needed) > 10
    assert not any(re.match(r"(pytest|mypy|ruff|coverage)\b", text) for text in needed)


def commands():
    """Every command of the README, once, words in capitals filled in."""
    lines = [line for line in shell_lines(README) if line.split()[0] in main.commands]
    assert "scenes [NAME] [--schema]" in lines
    lines += ["scenes", "scenes noise", "scenes --schema"]
    whole = [line for line in dict.fromkeys(lines) if "[" not in line and "..." not in line]
    assert {line.split()[0] for line in whole} == set(main.commands)
    whole.remove("study --report")  # its own test
    return [re.sub(r"\bFILE\b(?!\.)", "map.txt", line) for line in whole]


@pytest.fixture(scope="module")
def alone(wheel, tmp_path_factory):
    """The wheel, seeing packages that it depends on, but no sources; and in its folder
    a scene and a map of heights."""
    there = Installed(tmp_path_factory.mktemp("alone"), sys.executable)
    there.install("--no-deps", "--no-index", wheel)
    there.see_packages_of_this_environment()
    where = there.run("python", "-c", "import frictionjax; print(frictionjax.__file__)")
    assert PurePath(where).is_relative_to(there.home)
    assert not list(there.place.iterdir())
    there.run("frictionjax", "scenes", "angular-spring", "--out", "SCENE.toml")
    write_map(there.place / "map.txt")
    return there


def write_map(file):
    """Grooves that lean: three rows, period 9e-6 m."""
    phase = 2 * np.pi * np.arange(120) * 3e-7 / 9e-6
    rows = [a * np.sin(phase) + 0.2 * np.sin(2 * phase) for a in (0.9, 1.0, 1.1)]
    text = "\n".join(" ".join(f"{v:.9g}" for v in row) for row in rows)
    file.write_text(f"pixel size=3e-7 m\nheight conversion factor (-> m)=1e-7\n{text}\n")


@pytest.mark.slow
def test_the_ten_lines_run_from_the_wheel_alone(alone):
    require_what_ten_lines_print(alone.run("python", "-c", ten_lines()))


@pytest.mark.slow
@pytest.mark.parametrize("command", commands())
def test_commands_of_the_readme_run_from_the_wheel_alone(alone, command):
    printed = alone.run("frictionjax", *command.split())
    assert printed.strip()
    for place in re.findall(r"^Written to ([^:\n]+)", printed, re.MULTILINE):
        written = alone.place / place
        assert written.stat().st_size if written.is_file() else list(written.iterdir())


@pytest.mark.slow
def test_the_main_job_leaves_what_the_readme_says(alone):
    """Data, pictures and `report.html`."""
    folder = "frictionjax-study"
    assert f"in the folder `{folder}`" in README.read_text()
    shutil.rmtree(alone.place / folder, ignore_errors=True)
    alone.run("frictionjax", "study", "--report")
    names = {path.name for path in (alone.place / folder).iterdir()}
    assert "report.html" in names
    assert {".nc", ".png", ".toml", ".txt"} <= {PurePath(name).suffix for name in names}


@pytest.mark.slow
@pytest.mark.parametrize("version", ["3.11", "3.12", "3.13", "3.14"])
def test_the_wheel_runs_on_other_pythons_with_the_latest_of_all(wheel, tmp_path, version):
    """Through the shell too, which asks XLA for what later versions may not know."""
    python = python_named(version)
    assert version in SpecifierSet(metadata(wheel)["Requires-Python"])
    skip_without_index(tmp_path / "asked")
    there = Installed(tmp_path, python)
    there.install(wheel)
    assert there.run("python", "--version").startswith(f"Python {version}.")
    require_what_ten_lines_print(there.run("python", "-c", ten_lines()))
    assert "rho_plus" in there.run("frictionjax", "friction")
    assert "no cell failed" in there.run(
        "frictionjax", "study", "--eps", "0.1:0.01:4", "--gamma", "1", "--no-progress"
    )
    assert there.run("python", "-c", STEPS_OF_PROGRAMS).split() == ["True"] * 3


STEPS_OF_PROGRAMS = """
import jax
import jax.numpy as jnp
jax.config.update("jax_enable_x64", True)
import frictionjax as fx
many = jnp.zeros(24).at[0].set(0.01)  # in blocks, which a loop goes through
bristle = fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.5)
found = fx.friction(fx.profiles.Fourier(cos=0 * many, sin=many), bristle)
plain = fx.friction(fx.profiles.Sine(0.02 * jnp.pi), bristle)
print(abs(float(found.rho_plus - plain.rho_plus)) < 1e-12)
spring = fx.supports.Spring(1.0)
def load(t):
    step = lambda total, k: (total + jnp.sin(k * t) / k**2, k)
    waves, _ = jax.lax.scan(step, 0.0 * t, 1.0 + jnp.arange(3))
    return 0.1 * waves + jnp.polyval(jnp.array([0.1, 0.2, 0.0]), t)
whole = fx.loads.Custom(load)
scene = fx.Scene(fx.profiles.Sine(0.1), bristle, spring, whole, duration=4.0)
print(fx.solve_limit(scene, [4.0]).status.name == "OK")
print(fx.solve(scene, 0.1, 1.0, [4.0]).status.name == "OK")
"""
