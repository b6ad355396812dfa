"""The library as a user has it: from its wheel, in an environment made for the test."""

import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import pytest
from readme import HOME

# What this process was told, and a user's has not been.
_TOLD = "JAX_", "XLA_", "MPL", "OPENBLAS_", "PYTHON", "SHAPES_"


def built(folder: Path) -> Path:
    """The wheel, built by what pyproject.toml asks for, without network."""
    offline = "--no-index", "--no-build-isolation", "--no-deps"
    _pip("wheel", *offline, "-w", folder, HOME)
    (wheel,) = folder.glob("*.whl")
    return wheel


class Installed:
    """A virtual environment, and an empty folder beside it in which commands run."""

    def __init__(self, folder: Path, python: str):
        self.home, self.place = folder / "environment", folder / "empty"
        self.place.mkdir()
        self.python = self.home / "bin" / "python"
        self._env = {k: v for k, v in os.environ.items() if not k.startswith(_TOLD)}
        self._env["XDG_CACHE_HOME"] = str(folder / "cache")
        if python == sys.executable:
            venv.create(self.home, symlinks=True)
        else:
            _require_success(subprocess.run([python, "-m", "venv", self.home], **_CAUGHT))

    def install(self, *arguments) -> None:
        _pip("--python", self.python, "install", *arguments)

    def see_packages_of_this_environment(self) -> None:
        """Those in its folders of packages: links to sources lie in files that only an
        environment's own Python reads."""
        folders = [p for p in sys.path if p.endswith(("site-packages", "dist-packages"))]
        (site,) = self.home.glob("lib/python3*/site-packages")
        (site / "beside.pth").write_text("\n".join(folders))

    def run(self, *command) -> str:
        """What a command prints that succeeds."""
        program = self.home / "bin" / command[0]
        told = [program, *map(str, command[1:])]
        done = subprocess.run(told, cwd=self.place, env=self._env, **_CAUGHT)
        return _require_success(done)


def python_named(version: str) -> str:
    """A Python of this version on PATH. Skips where there is none that starts."""
    name = f"python{version}"
    found = shutil.which(name)
    if found is None or subprocess.run([found, "-c", ""], **_CAUGHT).returncode:
        pytest.skip(f"no {name} on PATH")
    return found


def skip_without_index(folder: Path) -> None:
    """Skip where pip reaches no index of packages."""
    asked = "--timeout", "15", "--retries", "0", "--no-deps", "-d", folder, "click"
    command = [sys.executable, "-m", "pip", "download", *asked]
    if subprocess.run(command, **_CAUGHT).returncode:
        pytest.skip("pip reaches no index of packages")


_CAUGHT = {"capture_output": True, "text": True}


def _pip(*arguments) -> str:
    command = [sys.executable, "-m", "pip", "--disable-pip-version-check", *arguments]
    return _require_success(subprocess.run(list(map(str, command)), **_CAUGHT))


def _require_success(done) -> str:
    said = f"{done.args}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}"
    assert done.returncode == 0, said
    return done.stdout
