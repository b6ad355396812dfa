"""Rooms and floors of the library: imports go down, and through the doors of packages."""

import ast
import functools
import re
import sys
import tomllib
from collections import Counter
from graphlib import TopologicalSorter
from pathlib import Path

import frictionjax

ROOT = Path(frictionjax.__file__).parent
TESTS = Path(__file__).parent
HOME = TESTS.parent

# Of every package that holds packages: its floors from the bottom. Units on one floor know
# nothing of each other.
FLOORS = {
    "": [
        {"_checks"},
        {"_compile", "_text", "numerics"},
        {"intervals"},
        {"profiles", "bristles", "supports", "loads", "effects", "rods"},
        {"tables", "coefficients"},
        {"model"},
        {"stochastic", "turning", "slide_laws"},
        {"called_for"},
        {"measured", "limit", "wiggly", "certificate"},
        {"contact", "principle", "crawling"},
        {"io", "sweeps", "convergence"},
        {"cost", "explain"},
        {"plot"},
        {"design"},
        {"studies", "rate_dependence", "explore"},
        {"report"},
        {"cli"},
        {"__main__"},
    ],
    "wiggly": [
        {"stepping", "reverse_mode"},
        {"equation", "rosenbrock", "solved_scene", "how_obtained", "problem"},
        {"sequential", "lanes", "limit_path", "settings", "solution", "turning"},
        {"slip_map", "inertial"},
        {"enclosure"},
        {"sums", "ways"},
        {"lane_steps"},
        {"plan"},
        {"attempts"},
        {"predicted_work"},
        {"batch"},
        {"arrays", "differentiable"},
        {"engine_solutions"},
        {"trajectory"},
    ],
    "certificate": [
        {"settings", "forces", "limit_curve"},
        {"following"},
        {"curve", "verdicts", "sample_gaps"},
        {"transits", "tube", "critical_places", "massive_steps"},
        {"plain_curve", "massive_course"},
        {"array_curves", "bent_root", "shadow"},
        {"turning_curve", "massive_curve"},
        {"certification"},
    ],
    "design": [
        {"common"},
        {"bristle", "surface"},
        {"slide", "measured_trace"},
        {"trace", "ensembles"},
    ],
    "design.surface": [
        {"barrier", "settings", "status"},
        {"exchange", "starts", "reachable", "history"},
        {"multistart", "open_directions", "seen_family"},
        {"least_bent", "array_surface", "fallback", "result"},
        {"flattened"},
        {"report"},
        {"fit"},
    ],
}
MOST_FILES = 16  # in one folder
ROOF = {"plot", "report", "cli"}  # where matplotlib may be imported
FILES = sorted(ROOT.rglob("*.py"))
STUBS = sorted(ROOT.rglob("*.pyi"))


def module_of(path):
    """Dotted name below the package, `""` for the package itself."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_of(path) for path in FILES}
PACKAGES = {module_of(path) for path in FILES if path.name == "__init__.py"}


@functools.cache
def parsed(path):
    return ast.parse(path.read_text())


@functools.cache
def imported(path):
    """What a file names anywhere: modules of the library, and packages outside."""
    inside, outside = set(), set()
    for node in ast.walk(parsed(path)):
        if isinstance(node, ast.Import):
            outside |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            outside.add(node.module.split(".")[0])
        elif isinstance(node, ast.ImportFrom):
            inside |= targets(node, package_of(path))
    return frozenset(inside), frozenset(outside)


def package_of(path):
    """Where relative imports of a file start."""
    return ".".join(path.relative_to(ROOT).parent.parts)


def targets(node, package):
    """What `from ..base import names` reaches: `base.name` where that is a module."""
    above = package.split(".") if package else []
    base = ".".join(above[: len(above) - (node.level - 1)] + (node.module or "").split("."))
    base = base.strip(".")
    names = {f"{base}.{alias.name}".strip(".") for alias in node.names}
    return {name if name in MODULES else base for name in names} - {""}


def fork(one, other):
    """Where two dotted names part: the package of both, and the next name in each."""
    a, b = one.split("."), other.split(".")
    same = 0
    while same < min(len(a), len(b)) and a[same] == b[same]:
        same += 1
    return ".".join(a[:same]), a[same : same + 1], b[same : same + 1]


def level_in(package, unit):
    levels = [level for level, floor in enumerate(FLOORS[package]) if unit in floor]
    assert len(levels) == 1, f"{package}.{unit} has no floor: add it to FLOORS"
    return levels[0]


def broken(rule, paths):
    """What a rule says is wrong with each file, by file.

    One case a rule: with one a file and rule there were 1,900, most of their time pytest's.
    """
    found = {str(path): [*rule(path)] for path in paths}
    return {path: wrong for path, wrong in found.items() if wrong}


def imports_from_above(path):
    module = module_of(path)
    inside, outside = imported(path)
    if "frictionjax" in outside:
        yield "import relatively"
    for target in inside if path.name != "__init__.py" else ():
        package, (unit,), rest = fork(module, target)
        floored = rest and package in FLOORS
        if floored and level_in(package, rest[0]) >= level_in(package, unit):
            yield f"{module} imports {target}"


def test_files_import_from_floors_below():
    assert not broken(imports_from_above, FILES)


def namespaces():
    """Files that a face offers as they are: `from . import interval as interval`."""
    for path in FILES:
        for node in parsed(path).body if path.name == "__init__.py" else ():
            if isinstance(node, ast.ImportFrom) and node.level == 1 and not node.module:
                yield from (f"{module_of(path)}.{alias.name}" for alias in node.names)


NAMESPACES = frozenset(namespaces())


def imports_past_doors(path):
    home = package_of(path)
    for target in imported(path)[0] - NAMESPACES:
        if target not in PACKAGES:
            if target.rpartition(".")[0] != home:
                yield f"import the package of {target}"
        elif target != home:
            above, _, below = fork(home, target) if home else ("", [], [target])
            door = ".".join([*filter(None, [above]), *below[:1]])
            if not below:
                yield f"{target} holds {home}: import what it takes it from"
            elif target != door:
                yield f"{target}: import from {door}"


def test_other_packages_are_entered_by_their_doors():
    """What is imported is a file of the same folder, or the face of another package."""
    assert not broken(imports_past_doors, FILES)


def test_faces_say_what_they_hold():
    for path in FILES:
        if path.name == "__init__.py":
            assert ast.get_docstring(parsed(path)), path


def names_astray(path):
    package = __import__(f"frictionjax.{package_of(path)}".rstrip("."), fromlist=["_"])
    for node in parsed(path).body:
        for alias in getattr(node, "names", ()):
            if getattr(package, alias.asname or alias.name, None) is None:
                yield f"{alias.asname or alias.name} cannot be imported"
            submodule = f"{package.__name__}.{alias.name}".partition(".")[2]
            if submodule in MODULES and submodule not in PACKAGES:
                yield f"{alias.name} is the name of a file"


def test_every_name_of_a_face_can_be_imported():
    assert not broken(names_astray, STUBS)


def test_no_folder_holds_many_files():
    sizes = Counter(package_of(path) for path in FILES if path.name != "__init__.py")
    assert max(sizes.values()) <= MOST_FILES, sizes.most_common(3)
    assert {path.name for path in ROOT.glob("*.py")} == {"__init__.py", "__main__.py"}


def public_names(path):
    for node in parsed(path).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names = [node.name]
        elif isinstance(node, ast.Assign):
            names = [target.id for target in node.targets if isinstance(target, ast.Name)]
        else:
            names = []
        yield from (name for name in names if not name.startswith("_"))


# Names of the library's face that stand for two things by design, each in its own package.
SHARED = {"Custom", "Sine", "fit_profile"}
SETTINGS = {"Settings", "SETTINGS"}  # of one package, in its `settings.py`


def test_a_public_name_stands_for_one_thing():
    """`intervals` is left out: its files are arithmetics, used as namespaces; so are the
    shell's commands, named as what they call."""
    left_out = {"intervals", "cli"}
    homes = {}
    for path in FILES:
        if module_of(path).split(".")[0] not in left_out:
            for name in public_names(path):
                homes.setdefault(name, []).append(module_of(path))
    twice = {name: places for name, places in homes.items() if len(places) > 1}
    assert twice.keys() - SETTINGS <= SHARED, twice


def draws_elsewhere(path):
    if "matplotlib" in imported(path)[1] and module_of(path).split(".")[0] not in ROOF:
        yield "imports matplotlib"


def test_matplotlib_stays_under_the_roof():
    assert not broken(draws_elsewhere, FILES)


def test_imports_never_loop():
    """Neither among files nor among the packages of a package."""
    files = {module_of(p): imported(p)[0] for p in FILES if module_of(p)}
    files = {module: needs - {module} for module, needs in files.items()}
    assert list(TopologicalSorter(files).static_order())
    for package in FLOORS:
        units = {}
        for module, needs in files.items():
            for target in needs:
                where, unit, rest = fork(module, target)
                if where == package and unit and rest:
                    units.setdefault(unit[0], set()).add(rest[0])
        assert list(TopologicalSorter(units).static_order())


def in_pyproject():
    with (HOME / "pyproject.toml").open("rb") as file:
        return tomllib.load(file)


def test_packages_that_the_library_imports_are_declared():
    """Not only what they need themselves, which may change with their next release."""
    project = in_pyproject()["project"]
    extras = project["optional-dependencies"]
    declared = {
        re.split(r"[^\w-]", requirement)[0].replace("-", "_")
        for requirement in sum(
            (extras[name] for name in ("instruments", "notebooks")), project["dependencies"]
        )
    }
    needed = set().union(*(imported(path)[1] for path in FILES))
    assert needed - set(sys.stdlib_module_names) <= declared


# Tests of no one package: of the repository, of scenes that are hard for the whole library,
# of what people hand over, and of what every solution satisfies.
CUTTING_ACROSS = {
    "test_examples",
    "test_layers",
    "test_notebooks",
    "test_pages",
    "test_promises",
    "test_shapes",
    "test_wheel",
    "_checks/test_arrays",
    "_checks/test_inside_jit",
    "_checks/test_precision",
    "_compile/test_nothing_unasked",
    "wiggly/test_guarantees",
    "wiggly/test_random_scenes",
}
TEST_FILES = [path.relative_to(TESTS) for path in sorted(TESTS.rglob("test_*.py"))]


def subjects(folder):
    """What tests in a folder may be of: files and packages of that package, and itself."""
    package = ROOT / folder
    assert (package / "__init__.py").exists(), f"no package {folder}"
    below = {path.parent.name for path in package.glob("*/__init__.py")}
    return {path.stem for path in package.glob("*.py")} | below | {package.name}


def of_no_subject(path):
    if path.parent.name != "hard" and str(path.with_suffix("")) not in CUTTING_ACROSS:
        name = path.stem.removeprefix("test_")
        starts = {name} | {name[: m.start()] for m in re.finditer("_", name)}
        if not starts & subjects(path.parent):
            yield "tests no file of its package"


def test_tests_mirror_packages():
    """`test_x.py` and `test_x_of_some_kind.py` test the file or the package `x` there."""
    assert not broken(of_no_subject, TEST_FILES)


def test_the_longest_tests_are_named_as_they_are():
    for node in ast.parse((TESTS / "conftest.py").read_text()).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "_LONGEST":
            names = set(ast.literal_eval(node.value))
    folders = {str(path.parent) for path in TEST_FILES}
    assert names <= folders | {str(path.with_suffix("")) for path in TEST_FILES}


def test_types_of_every_benchmark_are_checked():
    """Scripts that are not listed would be taken for code without a body."""
    settings = in_pyproject()["tool"]["mypy"]
    (scripts,) = settings["overrides"]
    assert settings["check_untyped_defs"]
    assert scripts["module"] == sorted(p.stem for p in (HOME / "benchmarks").glob("*.py"))
