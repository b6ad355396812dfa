"""Scene files: a scene and its study as TOML."""

import difflib
import inspect
import os
import tomllib
from collections.abc import Iterable
from importlib import resources
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import tomli_w

from .._checks import Asked, Part, asked_names, kind_of, require, require_flags, write_whole
from ..effects import AbstractEffect
from ..loads import Pulled
from ..measured import fit_profile, read_heights
from ..model import BristlePotential, GivenPotential, Scene, no_rest
from ..profiles import Fourier
from .named_functions import (
    FUNCTION_KINDS,
    FunctionKind,
    PathWithFunctions,
    function_of,
    name_of,
    need,
)
from .registry import EFFECTS, PARTS, numbers_of_part

_TOP = ("duration", "z0")
_STUDY = ("eps", "gamma", "accuracy", "effects")
_EFFECTS = ("all", "auto")  # of a study: those of the scene, or those called for
_TEXTS = ("length_unit", "height_unit", "decimal", "outliers")
_READING = ("pixel", "height_scale", *_TEXTS)
_WHOLE = ("harmonics", "row", "points")
_FIT = ("period", "smoothing", *_WHOLE)


_SAVE = "save it as UTF-8, which TOML is"
_SAVED = "a profile and a bristle, or functions that a module holds by name"
_NAMED = "functions that a module holds by name"


class SceneFile(NamedTuple):
    """What a scene file holds: the scene, and `eps gamma accuracy effects` where given."""

    scene: Scene
    study: dict[str, Any]


class _Reading(NamedTuple):
    """Where a file is, and whether functions that it names may be imported."""

    folder: Path
    functions: bool


def load_scene(path: Any, functions: bool = False) -> Scene:
    """Read the scene of a TOML file, at `path`.

    Tables `[profile] [bristle] [support] [load]`, each with `kind` (the class's name) and
    the constructor's arguments by name (of a `Pulled` load `position` is a table too,
    `[load.position]`); `duration` and `z0` on top. Effects are tables `[[effects]]`,
    likewise. A table `[study]` may
    be there and is not used. A `Fourier` profile may give `heights`, the file of a measured
    surface (relative to this one), with the options of `read_heights` and `fit_profile`.

    Parts made of functions name them, `fn = "module:function"`: `Custom` profiles, bristles
    (`offset`, `energy`) and loads, `Convex` supports (`energy`), and in place of profile
    and bristle a table `[potential]` of kind `GivenPotential` (`W`, `Q`). Modules are
    looked for beside the file, then where Python looks. That runs their code: only with
    `functions`.

    Returns a `Scene`.

    Raises `ValueError` naming the file, the table and the key, and what is allowed.

    >>> fx.save_scene(scene, "slanted.toml")
    >>> fx.load_scene("slanted.toml").bristle
    SlantedSpring(stiffness=1, rest_length=2.4, height=1, angle=1)
    """
    return load_study(path, functions).scene


def load_study(path: Any, functions: bool = False) -> SceneFile:
    """Read scene and study of a TOML file; see `load_scene`."""
    named = isinstance(path, str | os.PathLike)
    require(named, "path", kind_of(path), "the path of a TOML file")
    try:
        text = Path(path).read_text(encoding="utf-8-sig")  # Windows' editors mark a file
    except OSError as problem:
        raise ValueError(f"{path}: cannot be read ({problem.strerror})") from None
    except UnicodeDecodeError as problem:
        raise ValueError(f"{path}: cannot be read ({_encoding(problem)})") from None
    if "\0" in text:
        raise ValueError(f"{path}: cannot be read (UTF-16 or no text; {_SAVE})")
    require_flags(functions=functions)
    functions = functions or isinstance(path, PathWithFunctions)
    return parse_scene(text, str(path), Path(path).parent, functions)


def _encoding(problem: UnicodeDecodeError) -> str:
    """What is in a file that is not UTF-8, and where."""
    data, at = problem.object, problem.start
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return f"UTF-16; {_SAVE}"
    if b"\0" in data:
        return f"no text; {_SAVE}"
    line = data.count(b"\n", 0, at) + 1
    return f"not UTF-8, byte 0x{data[at]:02x} in line {line}; {_SAVE}"


def default_study() -> SceneFile:
    """The embedded scene, for commands that name none."""
    return parse_scene(_embedded(), "default_scene.toml")


def default_numbers() -> dict[str, Any]:
    """Of its study alone, for those of a scene that names none."""
    return _study_of(tomllib.loads(_embedded())["study"])


def _embedded() -> str:
    source = resources.files(__package__) / "default_scene.toml"
    return source.read_text(encoding="utf-8")


def parse_scene(
    text: str, name: str, folder: Path | None = None, functions: bool = False
) -> SceneFile:
    """Scene and study of the TOML document `text`, called `name` in errors.

    `folder`: where what it names is looked for, measured surfaces and modules.
    `functions`: whether these may be imported.
    """
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as problem:
        raise ValueError(f"{name}: not TOML ({problem})") from None
    except RecursionError:
        raise ValueError(f"{name}: not a scene (lists or tables nested too deep)") from None
    try:
        scene = _scene_of(document, _Reading(folder or Path(), functions))
        return SceneFile(scene, _study_of(document.get("study", {})))
    except ValueError as problem:
        raise ValueError(f"{name}: {problem}") from None


def _scene_of(document: dict[str, Any], reading: _Reading) -> Scene:
    tables = _tables("potential" in document)
    known = (*_TOP, *tables, "effects", "study")
    _require_keys("", document, known, ("duration", *tables))
    parts = {table: _part_of(table, document[table], reading) for table in tables}
    effects = _effects_of(document.get("effects", []))
    top = {key: document.get(key, 0.0) for key in _TOP}
    for key, value in top.items():
        need(not isinstance(value, list), f"{key} = {value!r}", "a number")
    numbers = {key: _numbers(key, value) for key, value in top.items()}
    return Scene(**parts, **numbers, effects=effects)


def _tables(given: bool) -> tuple[str, ...]:
    """Of a scene whose potential is given, or is that of a bristle."""
    return ("potential", "support", "load") if given else tuple(PARTS)


def _effects_of(tables: Any) -> tuple[AbstractEffect, ...]:
    good = isinstance(tables, list) and all(isinstance(table, dict) for table in tables)
    need(good, f"effects = {tables!r}", "tables [[effects]]")
    names = [f"[[effects]] no. {i}" for i in range(1, len(tables) + 1)]
    names = ["[[effects]]"] if len(tables) == 1 else names
    return tuple(_built(n, t, EFFECTS) for n, t in zip(names, tables, strict=True))


def _part_of(table: str, entries: Any, reading: _Reading) -> Any:
    need(isinstance(entries, dict), f"{table} = {entries!r}", f"a table [{table}]")
    if entries.get("kind") == "Fourier" and table == "profile" and "heights" in entries:
        given = {key: value for key, value in entries.items() if key != "kind"}
        return _measured_profile(given, reading.folder)
    of_functions = FUNCTION_KINDS[table]
    kind = entries.get("kind")
    if isinstance(kind, str) and kind in of_functions:
        return _built_of_functions(f"[{table}]", entries, of_functions[kind], reading)
    others = dict.fromkeys(of_functions)
    return _built(f"[{table}]", entries, PARTS.get(table, {}), others)


def _built_of_functions(
    where: str, entries: dict[str, Any], kind: FunctionKind, reading: _Reading
) -> Any:
    given = {key: value for key, value in entries.items() if key != "kind"}
    names = *kind.functions, *kind.numbers
    needed = [name for name in names if name not in kind.optional]
    _require_keys(f"{where} ", given, names, needed)
    for key, value in given.items():
        if key in kind.functions:
            given[key] = function_of(f"{where} {key}", value, *reading)
        elif key in _WHOLE:
            said = f"{where} {key} = {value!r}"
            whole = isinstance(value, int) and not isinstance(value, bool)
            need(whole, said, "a whole number")
        else:
            given[key] = _numbers(f"{where} {key}", value)
    try:
        return kind.build(**given)
    except TypeError as problem:  # of another number of arguments, by the function
        raise ValueError(f"{where} {problem}") from problem


def _built(
    where: str,
    entries: dict[str, Any],
    kinds: dict[str, type[Part]],
    others: Iterable[str] = (),
) -> Any:
    """The part of a table; `where`: the table, as the file writes it. `others`: kinds that
    it might be too."""
    kind = entries.get("kind")
    known = isinstance(kind, str) and kind in kinds
    said = "no kind" if kind is None else f"kind = {kind!r}"
    listed = *kinds, *others
    needs = f"a kind that is one of {', '.join(listed)}{_meant(kind, listed)}"
    need(known, f"{where} {said}", needs)
    build = kinds[str(kind)]
    given = {key: value for key, value in entries.items() if key != "kind"}
    names = asked_names(build, {})
    signature = inspect.signature(build.__init__).parameters
    needed = [n for n in names if signature[n].default is inspect.Parameter.empty]
    _require_keys(f"{where} ", given, names, needed)
    return build(**{k: _argument(where, k, v, build.asked[k]) for k, v in given.items()})


def _argument(where: str, key: str, value: Any, asked: Asked) -> Any:
    if key != "position":
        return _numbers(f"{where} {key}", value, _needed(asked))
    # Of the end that a load is pulled by: a part too, but not pulled again.
    need(isinstance(value, dict), f"{where} {key} = {value!r}", "a table [load.position]")
    return _built("[load.position]", value, _without(PARTS["load"], Pulled))


def _needed(asked: Asked) -> str:
    """What is allowed, as a file's number or numbers."""
    return f"{'a list of numbers' if asked.row else 'a number'} ({asked})"


def _without(kinds: dict[str, type[Part]], kind: type[Part]) -> dict[str, type[Part]]:
    return {name: known for name, known in kinds.items() if known is not kind}


def _meant(word: Any, known: Iterable[str]) -> str:
    """The nearest known word, as a question."""
    near = difflib.get_close_matches(str(word), list(known), n=1)
    return f" ({near[0]}?)" if near else ""


def _measured_profile(given: dict[str, Any], folder: Path) -> Fourier:
    _require_keys("[profile] ", given, ("heights", *_FIT, *_READING), ())
    name = given["heights"]
    text = isinstance(name, str)
    need(text, f"[profile] heights = {name!r}", "the name of a file")
    options = {key: _option(key, given[key]) for key in given if key != "heights"}
    reading = {key: options.pop(key) for key in _READING if key in options}
    measured = read_heights(folder / name, **reading)
    try:
        return fit_profile(measured, **options).profile
    except ValueError as error:
        raise ValueError(f"{folder / name}: {error}") from None


def _option(key: str, value: Any) -> Any:
    if key in _TEXTS:
        need(isinstance(value, str), f"[profile] {key} = {value!r}", "a text")
        return value
    whole = isinstance(value, int) and not isinstance(value, bool)
    said = f"[profile] {key} = {value!r}"
    need(whole or key not in _WHOLE, said, "a whole number")
    need(not isinstance(value, list), said, "a number")
    return value if key in _WHOLE else _numbers(f"[profile] {key}", value)


def _require_keys(where: str, entries: dict, known, needed) -> None:
    for key in entries:
        needs = f"one of {', '.join(known)}{_meant(key, known)}" if known else "no key"
        need(key in known, f"{where}{key} is unknown", needs)
    for key in needed:
        need(key in entries, f"{where}{key} is missing", f"all of {', '.join(needed)}")


def _numbers(name: str, value: Any, needed: str = "a number or a list of numbers") -> Any:
    """A number or a list of them, as floats; the constructor looks at how many."""
    rows = value if isinstance(value, list) else [value]
    plain = all(isinstance(v, int | float) and not isinstance(v, bool) for v in rows)
    need(plain, f"{name} = {value!r}", needed)
    try:
        numbers = [float(v) for v in rows]
    except OverflowError:
        raise ValueError(f"{name}: needs 64-bit numbers, one is larger") from None
    return numbers if isinstance(value, list) else numbers[0]


def _study_of(entries: Any) -> dict[str, Any]:
    need(isinstance(entries, dict), f"study = {entries!r}", "a table [study]")
    _require_keys("[study] ", entries, _STUDY, ())
    study = dict(entries)
    if "effects" in study:
        said = f"[study] effects = {study['effects']!r}"
        need(study["effects"] in _EFFECTS, said, f"one of {', '.join(_EFFECTS)}")
    numbers = {key: value for key, value in entries.items() if key != "effects"}
    for key, given in numbers.items():
        study[key] = value = _numbers(f"[study] {key}", given)
        good = np.size(value) > 0 and np.all(np.isfinite(value)) and np.min(value) > 0
        single = key != "accuracy" or np.ndim(value) == 0
        needs = "a number > 0" if key == "accuracy" else "one or more numbers > 0"
        need(good and single, f"[study] {key} = {value!r}", needs)
    return study


def save_scene(scene: Scene, path: Any, study: dict[str, Any] | None = None) -> None:
    """Write a `scene`, and a `[study]` table if one is given, so that it reads back equal.

    `path`: of the file; `study`: what the table holds, by name. Returns nothing.
    (A spline within a rounding: the file holds its heights, not B-spline coefficients.)
    Parts given as functions are told by their names, `"module:function"`; see `load_scene`.
    Raises `ValueError` for functions that no module holds by name.

    >>> from pathlib import Path
    >>> fx.save_scene(scene, "slanted.toml", study={"eps": [0.1, 0.01], "gamma": [1.0]})
    >>> Path("slanted.toml").read_text().splitlines()[3:6]
    ['[profile]', 'kind = "Sine"', 'slope = 0.1']
    """
    write_whole(path, scene_document(scene, study))


def scene_document(scene: Scene, study: dict[str, Any] | None = None) -> str:
    """The TOML document of a scene; see `save_scene`."""
    given = isinstance(scene.potential, GivenPotential)
    known = given or isinstance(scene.potential, BristlePotential)
    require(known, "scene.potential", type(scene.potential).__name__, _SAVED)
    document: dict[str, Any] = {key: float(getattr(scene, key)) for key in _TOP}
    for table in _tables(given):
        part = getattr(scene, table)
        document[table] = _entries_of(f"scene.{table}", part, PARTS.get(table, {}), table)
    if scene.effects:
        entries = [_entries_of("scene.effects", each, EFFECTS) for each in scene.effects]
        document["effects"] = entries
    if study:
        document["study"] = {
            key: value if isinstance(value, str) else _plain(value)
            for key, value in study.items()
        }
    return tomli_w.dumps(document)


def _entries_of(
    name: str, part: Any, kinds: dict[str, type[Part]], table: str = ""
) -> dict[str, Any]:
    kind = type(part).__name__
    of_functions = FUNCTION_KINDS.get(table, {}).get(kind)
    if of_functions is not None and of_functions.build is type(part):
        return {"kind": kind} | _named_functions(name, part, of_functions)
    saved = kinds.get(kind) is type(part)
    require(saved, name, kind, f"one of {', '.join(kinds)}")
    entries: dict[str, Any] = {"kind": kind}
    for key, value in numbers_of_part(part).items():
        inner = isinstance(value, Part)
        entries[key] = _entries_of(name, value, kinds) if inner else _plain(value)
    return entries


def _named_functions(name: str, part: Any, kind: FunctionKind) -> dict[str, Any]:
    stored = getattr(part, "_stored", {})
    entries: dict[str, Any] = {}
    defaults = inspect.signature(kind.build).parameters
    for key in kind.functions:
        fn = getattr(part, stored.get(key, key))
        if key in kind.optional and fn is no_rest:
            continue
        text = name_of(fn)
        require(text is not None, name, kind_of(part), f"{_NAMED}: {key} is none")
        entries[key] = text
    for key in kind.numbers:
        value = getattr(part, stored.get(key, key))
        if np.size(value) == 0 or value is defaults[key].default:
            continue
        entries[key] = value if key in _WHOLE else _plain(value)
    return entries


def _plain(value: Any) -> Any:
    return np.asarray(value, dtype=float).tolist()
