"""Imports go down only: the floors of the library, from the bottom."""

import ast
import tomllib
from pathlib import Path

import pytest

import frictionjax

ROOT = Path(frictionjax.__file__).parent

# Units on one floor know nothing of each other; a folder is one unit.
FLOORS = [
    {"surroundings"},
    {"arguments", "progress", "asymptotes", "whole_files"},
    {"grids", "viscosity", "parts", "text_units", "thousands"},
    {"text_tables"},
    {"kept_programs"},
    {"outcomes", "compilation", "programs"},
    {"roots", "taylor", "extrema", "trigonometry"},
    {"intervals"},
    {"profiles", "bristles", "supports", "loads"},
    {"potentials"},
    {"coefficients", "clearance", "digits"},
    {"given_rest"},
    {"admissibility"},
    {"friction_law"},
    {"scene", "measured"},
    {"strip"},
    {"slide_laws"},
    {"certificate_curve"},
    {"certificate_passages", "certificate_tube"},
    {"limit_system", "wiggly", "certificate"},
    {"provenance", "selected_cells"},
    {"cells"},
    {"blocks"},
    {"sweeps"},
    {"orders"},
    {"law_orders"},
    {"instants", "timed_runs", "machine_cost"},
    {"cost_prediction"},
    {"eps_grids"},
    {"error_measures"},
    {"references"},
    {"cost_of_accuracy"},
    {"plot"},
    {"design"},
    {"studies"},
    {"scene_files"},
    {"report"},
    {"cli"},
    {"__main__"},
]
LEVEL = {unit: level for level, floor in enumerate(FLOORS) for unit in floor}
ROOF = {"plot", "report", "cli"}  # where matplotlib may be imported
HELPERS = {("extrema", "roots")}  # one helper built on another, on the same floor
FILES = sorted(ROOT.rglob("*.py"))


def module_of(path):
    """Dotted name below the package, `""` for the package itself."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_of(path) for path in FILES}


def imported(path):
    """Modules of the library, and packages outside, that a file names anywhere."""
    module = module_of(path)
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    inside, outside = set(), set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            outside |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            outside.add(node.module.split(".")[0])
        elif isinstance(node, ast.ImportFrom):
            inside |= targets(node, package)
    return inside, outside


def targets(node, package):
    """What `from ..base import names` reaches: `base.name` where that is a module."""
    above = package.split(".") if package else []
    base = ".".join(above[: len(above) - (node.level - 1)] + (node.module or "").split("."))
    base = base.strip(".")
    names = {f"{base}.{alias.name}".strip(".") for alias in node.names}
    return {name if name in MODULES else base for name in names} - {""}


def unit_of(module):
    return module.split(".")[0]


@pytest.mark.parametrize("path", FILES, ids=module_of)
def test_a_file_imports_from_floors_below(path):
    module = module_of(path)
    if not module:
        return  # the package itself opens every floor, lazily
    unit = unit_of(module)
    assert unit in LEVEL, f"{module} has no floor: add it to FLOORS"
    inside, outside = imported(path)
    assert "frictionjax" not in outside, "import relatively"
    for target in inside:
        other = unit_of(target)
        if other != unit and (unit, other) not in HELPERS:
            assert other in LEVEL, f"{target} has no floor: add it to FLOORS"
            assert LEVEL[other] < LEVEL[unit], f"{module} imports {target}"


@pytest.mark.parametrize("path", FILES, ids=module_of)
def test_matplotlib_stays_under_the_roof(path):
    outside = imported(path)[1]
    assert "matplotlib" not in outside or unit_of(module_of(path)) in ROOF


def test_imports_never_loop():
    below = {module_of(path): imported(path)[0] for path in FILES if module_of(path)}
    below = {module: needs & below.keys() for module, needs in below.items()}
    done = set()
    while len(done) < len(below):
        ready = {m for m, needs in below.items() if m not in done and needs <= done | {m}}
        assert ready, f"a loop among {sorted(set(below) - done)}"
        done |= ready


def test_public_names_are_where_the_package_says():
    for name, home in frictionjax._HOME.items():
        if home in MODULES:
            assert getattr(frictionjax, name) is not None


def test_types_of_every_benchmark_are_checked():
    """Scripts that are not listed would be taken for code without a body."""
    home = Path(__file__).parent.parent
    with (home / "pyproject.toml").open("rb") as file:
        (scripts,) = tomllib.load(file)["tool"]["mypy"]["overrides"]
    assert scripts["check_untyped_defs"]
    assert scripts["module"] == sorted(p.stem for p in (home / "benchmarks").glob("*.py"))
