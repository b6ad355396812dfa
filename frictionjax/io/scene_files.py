"""Scene files: a scene and its study as TOML."""

import difflib
import inspect
import tomllib
from collections.abc import Iterable
from importlib import resources
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import tomli_w

from .._checks import Asked, Part, asked_names, require, write_whole
from ..effects import AbstractEffect
from ..loads import Pulled
from ..measured import fit_profile, read_heights
from ..model import BristlePotential, Scene
from ..profiles import Fourier
from .registry import EFFECTS, PARTS, numbers_of_part

_TOP = ("duration", "z0")
_STUDY = ("eps", "gamma", "accuracy", "effects")
_EFFECTS = ("all", "auto")  # of a study: those of the scene, or those called for
_TEXTS = ("length_unit", "height_unit", "decimal", "outliers")
_READING = ("pixel", "height_scale", *_TEXTS)
_WHOLE = ("harmonics", "row")
_FIT = ("period", "smoothing", *_WHOLE)


_SAVE = "save it as UTF-8, which TOML is"
_SAVED = "a profile and a bristle: what Python functions give cannot be saved"


class SceneFile(NamedTuple):
    """What a scene file holds: the scene, and `eps gamma accuracy effects` where given."""

    scene: Scene
    study: dict[str, Any]


def load_scene(path: Any) -> Scene:
    """Read the scene of a TOML file, at `path`.

    Tables `[profile] [bristle] [support] [load]`, each with `kind` (the class's name) and
    the constructor's arguments by name (of a `Pulled` load `position` is a table too,
    `[load.position]`); `duration` and `z0` on top. Effects are tables `[[effects]]`,
    likewise. A table `[study]` may
    be there and is not used. A `Fourier` profile may give `heights`, the file of a measured
    surface (relative to this one), with the options of `read_heights` and `fit_profile`.

    Returns a `Scene`.

    Raises `ValueError` naming the file, the table and the key, and what is allowed.

    >>> fx.save_scene(scene, "slanted.toml")
    >>> fx.load_scene("slanted.toml").bristle
    SlantedSpring(stiffness=1, rest_length=2.4, height=1, angle=1)
    """
    return load_study(path).scene


def load_study(path: Any) -> SceneFile:
    """Read scene and study of a TOML file; see `load_scene`."""
    try:
        text = Path(path).read_text(encoding="utf-8-sig")  # Windows' editors mark a file
    except OSError as problem:
        raise ValueError(f"{path}: cannot be read ({problem.strerror})") from None
    except UnicodeDecodeError as problem:
        raise ValueError(f"{path}: cannot be read ({_encoding(problem)})") from None
    if "\0" in text:
        raise ValueError(f"{path}: cannot be read (UTF-16 or no text; {_SAVE})")
    return parse_scene(text, str(path), Path(path).parent)


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
    source = resources.files(__package__) / "default_scene.toml"
    return parse_scene(source.read_text(encoding="utf-8"), source.name)


def parse_scene(text: str, name: str, folder: Path | None = None) -> SceneFile:
    """Scene and study of the TOML document `text`, called `name` in errors.

    `folder`: where a measured surface that it names is looked for.
    """
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as problem:
        raise ValueError(f"{name}: not TOML ({problem})") from None
    try:
        scene = _scene_of(document, folder or Path())
        return SceneFile(scene, _study_of(document.get("study", {})))
    except ValueError as problem:
        raise ValueError(f"{name}: {problem}") from None


def _scene_of(document: dict[str, Any], folder: Path) -> Scene:
    known = (*_TOP, *PARTS, "effects", "study")
    _require_keys("", document, known, ("duration", *PARTS))
    parts = {table: _part_of(table, document[table], folder) for table in PARTS}
    effects = _effects_of(document.get("effects", []))
    top = {key: document.get(key, 0.0) for key in _TOP}
    for key, value in top.items():
        _need(not isinstance(value, list), f"{key} = {value!r}", "a number")
    numbers = {key: _numbers(key, value) for key, value in top.items()}
    return Scene(**parts, **numbers, effects=effects)


def _effects_of(tables: Any) -> tuple[AbstractEffect, ...]:
    good = isinstance(tables, list) and all(isinstance(table, dict) for table in tables)
    _need(good, f"effects = {tables!r}", "tables [[effects]]")
    names = [f"[[effects]] no. {i}" for i in range(1, len(tables) + 1)]
    names = ["[[effects]]"] if len(tables) == 1 else names
    return tuple(_built(n, t, EFFECTS) for n, t in zip(names, tables, strict=True))


def _part_of(table: str, entries: Any, folder: Path) -> Any:
    _need(isinstance(entries, dict), f"{table} = {entries!r}", f"a table [{table}]")
    if entries.get("kind") == "Fourier" and table == "profile" and "heights" in entries:
        given = {key: value for key, value in entries.items() if key != "kind"}
        return _measured_profile(given, folder)
    return _built(f"[{table}]", entries, PARTS[table])


def _built(where: str, entries: dict[str, Any], kinds: dict[str, type[Part]]) -> Any:
    """The part of a table; `where`: the table, as the file writes it."""
    kind = entries.get("kind")
    known = isinstance(kind, str) and kind in kinds
    said = "no kind" if kind is None else f"kind = {kind!r}"
    needs = f"a kind that is one of {', '.join(kinds)}{_meant(kind, kinds)}"
    _need(known, f"{where} {said}", needs)
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
    _need(isinstance(value, dict), f"{where} {key} = {value!r}", "a table [load.position]")
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
    _need(text, f"[profile] heights = {name!r}", "the name of a file")
    options = {key: _option(key, given[key]) for key in given if key != "heights"}
    reading = {key: options.pop(key) for key in _READING if key in options}
    measured = read_heights(folder / name, **reading)
    try:
        return fit_profile(measured, **options).profile
    except ValueError as error:
        raise ValueError(f"{folder / name}: {error}") from None


def _option(key: str, value: Any) -> Any:
    if key in _TEXTS:
        _need(isinstance(value, str), f"[profile] {key} = {value!r}", "a text")
        return value
    whole = isinstance(value, int) and not isinstance(value, bool)
    said = f"[profile] {key} = {value!r}"
    _need(whole or key not in _WHOLE, said, "a whole number")
    _need(not isinstance(value, list), said, "a number")
    return value if key in _WHOLE else _numbers(f"[profile] {key}", value)


def _require_keys(where: str, entries: dict, known, needed) -> None:
    for key in entries:
        needs = f"one of {', '.join(known)}{_meant(key, known)}" if known else "no key"
        _need(key in known, f"{where}{key} is unknown", needs)
    for key in needed:
        _need(key in entries, f"{where}{key} is missing", f"all of {', '.join(needed)}")


def _need(condition: Any, said: str, allowed: str) -> None:
    """Like `require`, in the words of the file rather than of a constructor."""
    if not condition:
        raise ValueError(f"{said}: needs {allowed}")


def _numbers(name: str, value: Any, needed: str = "a number or a list of numbers") -> Any:
    """A number or a list of them, as floats; the constructor looks at how many."""
    rows = value if isinstance(value, list) else [value]
    plain = all(isinstance(v, int | float) and not isinstance(v, bool) for v in rows)
    _need(plain, f"{name} = {value!r}", needed)
    try:
        numbers = [float(v) for v in rows]
    except OverflowError:
        raise ValueError(f"{name}: needs 64-bit numbers, one is larger") from None
    return numbers if isinstance(value, list) else numbers[0]


def _study_of(entries: Any) -> dict[str, Any]:
    _need(isinstance(entries, dict), f"study = {entries!r}", "a table [study]")
    _require_keys("[study] ", entries, _STUDY, ())
    study = dict(entries)
    if "effects" in study:
        said = f"[study] effects = {study['effects']!r}"
        _need(study["effects"] in _EFFECTS, said, f"one of {', '.join(_EFFECTS)}")
    numbers = {key: value for key, value in entries.items() if key != "effects"}
    for key, given in numbers.items():
        study[key] = value = _numbers(f"[study] {key}", given)
        good = np.size(value) > 0 and np.all(np.isfinite(value)) and np.min(value) > 0
        single = key != "accuracy" or np.ndim(value) == 0
        needs = "a number > 0" if key == "accuracy" else "one or more numbers > 0"
        _need(good and single, f"[study] {key} = {value!r}", needs)
    return study


def save_scene(scene: Scene, path: Any, study: dict[str, Any] | None = None) -> None:
    """Write a `scene`, and a `[study]` table if one is given, so that it reads back equal.

    `path`: of the file; `study`: what the table holds, by name. Returns nothing.
    (A spline within a rounding: the file holds its heights, not B-spline coefficients.)
    Raises `ValueError` for parts given as functions, which a file cannot hold.

    >>> from pathlib import Path
    >>> fx.save_scene(scene, "slanted.toml", study={"eps": [0.1, 0.01], "gamma": [1.0]})
    >>> Path("slanted.toml").read_text().splitlines()[3:6]
    ['[profile]', 'kind = "Sine"', 'slope = 0.1']
    """
    write_whole(path, scene_document(scene, study))


def scene_document(scene: Scene, study: dict[str, Any] | None = None) -> str:
    """The TOML document of a scene; see `save_scene`."""
    known = isinstance(scene.potential, BristlePotential)
    require(known, "scene.potential", type(scene.potential).__name__, _SAVED)
    document: dict[str, Any] = {key: float(getattr(scene, key)) for key in _TOP}
    for table in PARTS:
        document[table] = _entries_of(f"scene.{table}", getattr(scene, table), PARTS[table])
    if scene.effects:
        entries = [_entries_of("scene.effects", each, EFFECTS) for each in scene.effects]
        document["effects"] = entries
    if study:
        document["study"] = {
            key: value if isinstance(value, str) else _plain(value)
            for key, value in study.items()
        }
    return tomli_w.dumps(document)


def _entries_of(name: str, part: Part, kinds: dict[str, type[Part]]) -> dict[str, Any]:
    kind = type(part).__name__
    saved = kinds.get(kind) is type(part)
    require(saved, name, kind, f"one of {', '.join(kinds)}: no functions")
    entries: dict[str, Any] = {"kind": kind}
    for key, value in numbers_of_part(part).items():
        inner = isinstance(value, Part)
        entries[key] = _entries_of(name, value, kinds) if inner else _plain(value)
    return entries


def _plain(value: Any) -> Any:
    return np.asarray(value, dtype=float).tolist()
