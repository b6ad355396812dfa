"""Docstrings of public names hold an example each, and what the examples say is so."""

import ast
import doctest
import enum
import inspect
import re
import types
from pathlib import Path

import jax
import matplotlib.pyplot as plt
import pytest
from promised import public_names

import frictionjax as fx
from frictionjax._compile import program_cache
from frictionjax.cost import prediction
from frictionjax.cost.machine_cost import ELSEWHERE

ROOT = Path(fx.__file__).parent
PUBLIC = {
    name: thing
    for name, thing in public_names().items()
    if callable(thing) and not isinstance(thing, types.ModuleType)
}
# How results show themselves, whichever class they are of.
SHOWN = {"table", "plot", "to_dataset"}
# Fits, and what takes some 10 CPU s and more with nothing compiled.
DEAR = {
    "fx.check_design",
    "fx.crawler",
    "fx.effects.RigidArray",
    "fx.explore",
    "fx.fit_angle",
    "fx.fit_profile",
    "fx.fit_slide",
    "fx.fit_slide_profile",
    "fx.fit_trace",
    "fx.friction_curve",
    "fx.order_cost",
    "fx.plot.draw_angle_fit",
    "fx.plot.draw_friction_curve",
    "fx.plot.draw_order_cost",
    "fx.plot.draw_profile_fit",
    "fx.plot.draw_slide_fit",
    "fx.plot.draw_slide_profile_fit",
    "fx.plot.draw_steady_slide",
    "fx.plot.draw_trace_fit",
    "fx.plot.draw_work_precision",
    "fx.simulate_trace",
    "fx.steady_slide",
    "fx.work_precision",
    "design.common.design_result.DesignResult.from_json",
    "design.common.design_result.DesignResult.to_json",
    "design.slide.check.DesignCheck.table",
    "design.slide.surface_fit.SlideProfileFit.plot",
    "design.surface.result.ProfileFit.family",
    "design.surface.result.ProfileFit.plot",
    "design.trace.result.TraceFit.plot",
    "explore.widget.ExplorePage.still",
}


def documented():
    """Docstrings in files of the library that matter here, by dotted name below it."""
    signs = ">>> ", *(f"def {name}(self" for name in SHOWN)
    for path in sorted(ROOT.rglob("*.py")):
        source = path.read_text()
        if any(sign in source for sign in signs):
            module = ".".join(path.relative_to(ROOT).with_suffix("").parts)
            yield from texts_in(ast.parse(source), module)


def texts_in(node, name):
    if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
        yield name, ast.get_docstring(node) or ""
        for inner in node.body:
            if isinstance(inner, ast.ClassDef | ast.FunctionDef):
                yield from texts_in(inner, f"{name}.{inner.name}")


WRITTEN = dict(documented())
OF_PUBLIC = {name: inspect.cleandoc(thing.__doc__ or "") for name, thing in PUBLIC.items()}
OTHERS = {
    name: text
    for name, text in WRITTEN.items()
    if ">>> " in text and text not in OF_PUBLIC.values()
}
EXAMPLES = OF_PUBLIC | OTHERS
AS_WRITTEN = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def shown():
    """Methods by which results show themselves: dotted names."""
    for name in WRITTEN:
        home, _, method = name.rpartition(".")
        if method in SHOWN and home.rpartition(".")[2][:1].isupper():
            yield name


@pytest.mark.parametrize("name", [*PUBLIC, *shown()])
def test_every_public_name_has_an_example(name):
    text = (OF_PUBLIC | WRITTEN)[name]
    found = doctest.DocTestParser().get_examples(text)
    assert any(example.want for example in found), f"help({name}) has no example"
    assert sum(len(example.source.splitlines()) for example in found) <= 5


def run(text, name, names):
    """What examples in a text say that is not so, and the names that they leave."""
    examples = doctest.DocTestParser().get_examples(text)
    test = doctest.DocTest(examples, names, name, name, 0, text)
    told = []
    runner = doctest.DocTestRunner(optionflags=AS_WRITTEN)
    runner.run(test, out=told.append, clear_globs=False)
    return "".join(told), test.globs


@pytest.fixture(scope="module")
def given():
    """`fx`, `np` and `scene`, made as the library's own docstring says."""
    wrong, names = run(fx.__doc__, "frictionjax", {})
    assert not wrong, wrong
    return {name: names[name] for name in ("fx", "np", "scene")}


@pytest.fixture
def as_before(tmp_path, monkeypatch):
    """A folder of its own, a machine that nobody has measured, and nothing left behind."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    monkeypatch.setattr(prediction, "known_machine", lambda: None)
    monkeypatch.setattr(prediction, "machine_cost", lambda: ELSEWHERE)
    for name in ("_place", "_writes"):
        monkeypatch.setattr(program_cache, name, getattr(program_cache, name))
    kept = "jax_compilation_cache_dir", "jax_persistent_cache_min_compile_time_secs"
    before = {name: getattr(jax.config, name) for name in kept}
    yield
    plt.close("all")
    for name, value in before.items():
        jax.config.update(name, value)


assert EXAMPLES.keys() >= DEAR, DEAR - EXAMPLES.keys()
CASES = [pytest.param(n, marks=[pytest.mark.slow] if n in DEAR else []) for n in EXAMPLES]


@pytest.mark.parametrize("name", CASES)
@pytest.mark.usefixtures("as_before")
def test_what_an_example_says_is_so(name, given):
    wrong, _ = run(EXAMPLES[name], name, given)
    assert not wrong, wrong


def said_of(name):
    """A docstring without its example."""
    return OF_PUBLIC[name].partition(">>> ")[0]


MADE_BY_ARGUMENTS = [
    name
    for name, thing in PUBLIC.items()
    if not (isinstance(thing, type) and issubclass(thing, enum.Enum | Warning))
]
FUNCTIONS = [name for name, thing in PUBLIC.items() if not isinstance(thing, type)]


@pytest.mark.parametrize("name", MADE_BY_ARGUMENTS)
def test_every_argument_is_named(name):
    marked = " ".join(re.findall(r"`([^`]*)`", said_of(name)))
    wanted = inspect.signature(PUBLIC[name]).parameters
    missing = [argument for argument in wanted if not re.search(rf"\b{argument}\b", marked)]
    assert not missing, f"help({name}) says nothing of {missing}"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_say_what_they_return_and_refuse(name):
    """Drawings are all Figures, as `fx.plot` says; most refuse what is no result."""
    text, drawn = said_of(name), name.startswith("fx.plot.draw_")
    assert "Returns " in text or drawn, f"help({name}) does not say what it returns"
    refuses = inspect.signature(PUBLIC[name]).parameters and not drawn
    assert "Raises `ValueError`" in text or not refuses, f"help({name}): what is refused?"
