"""Scenes of one sweep: one alone, or several under their labels."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Array, Float

from .._checks import exact_text, require
from .._compile import side_by_side
from ..called_for import Simulated
from ..effects import Engine, require_done
from ..limit import require_start_in_strip
from ..model import (
    Scene,
    require_reach,
    require_times,
    require_told_apart,
    scene_for,
)
from ..slide_laws import LAW_DIMS
from .scene_columns import Columns, SceneColumns


class SceneFamily(NamedTuple):
    """Scenes and what they are called; `labels` is None for one that was given alone.

    `asked`: as they were given, effects of the potential not yet worked in. `left_out`: in
    words, effects that were not called for.
    """

    scenes: list[Scene]
    labels: list[str] | list[int] | None
    asked: list[Scene]
    left_out: str = ""

    def each(self, work: Callable[[Scene], Any]) -> list[Any]:
        """What `work` makes of each; `ValueError`s name the scene that they are of."""
        return [self._named(work, number) for number in range(len(self.scenes))]

    def side_by_side(self, work: Callable[[Scene], Any]) -> list[Any]:
        """The same on a core each. (Planning is half of a small scene: on both cores one
        after the other they took 1.2 times as long.)"""
        numbers = range(len(self.scenes))
        return side_by_side("scenes", lambda number: self._named(work, number), numbers)

    def _named(self, work: Callable[[Scene], Any], number: int) -> Any:
        if self.labels is None:
            return work(self.scenes[number])
        try:
            return work(self.scenes[number])
        except ValueError as error:
            raise ValueError(f"scene {self.labels[number]!r}: {error}") from None


def family_of(
    given: Any,
    eps: Float[np.ndarray, " e"],
    engines: Sequence[Engine],
    simulate: Callable[[Any], Simulated],
) -> SceneFamily:
    """The scenes of an argument, each as it can be solved at these eps (m).

    `simulate`: which of a scene's effects are.

    Raises `ValueError` for what is neither a scene nor a list or mapping of them, and as
    `sweep` does for each of them.
    """
    if isinstance(given, Mapping):
        asked, labels = list(given.values()), _labels(list(given))
    elif isinstance(given, list | tuple):
        asked, labels = list(given), list(range(len(given)))
    else:
        several = "a Scene, or several in a list, a tuple or a mapping"
        require(not isinstance(given, Iterator), "scene", type(given).__name__, several)
        asked, labels = [given], None
    require(asked, "scene", given, "a Scene, or several")
    family = SceneFamily(asked, labels, asked)
    found = family.each(simulate)
    family = family._replace(
        scenes=[one.scene for one in found], left_out=_left_out(found, labels)
    )

    def solvable(scene: Any) -> Scene:
        for engine in engines:
            require_done(getattr(scene, "effects", ()), engine)
        scene = scene_for(Engine.SWEEP, scene)
        require_start_in_strip(scene)
        require_reach(scene.potential, eps)
        require_told_apart(scene, eps)
        return scene

    return family._replace(scenes=family.each(solvable))


def _left_out(found: list[Simulated], labels: list[Any] | None) -> str:
    if labels is None:
        return found[0].in_words
    pairs = zip(labels, found, strict=True)
    return "; ".join(f"{label}: {one.in_words}" for label, one in pairs if one.left_out)


def _labels(names: list[Any]) -> list[Any]:
    require(names, "scene", names, "a Scene, or several")
    plain = [int(name) if isinstance(name, np.integer) else name for name in names]
    kinds = {type(name) for name in plain}
    # Larger ones a file has no room for.
    good = kinds == {str} or (kinds == {int} and max(map(abs, plain)) < 2**63)
    allowed = "labels that are all str, or all int of 64 bits"
    require(good, "scene", f"labels {names[:4]}", allowed)
    return plain


def times_of(family: SceneFamily, ts: Any) -> Float[Array, " n"]:
    """Times in s for all scenes: those asked for, or even ones where none are.

    Raises `ValueError` as `require_times`, and where none are asked for and durations
    differ.
    """
    if ts is None:
        ends = sorted({float(scene.duration) for scene in family.scenes})
        needs = f"times ts, as scenes last from {ends[0]:.6g} to {ends[-1]:.6g} s"
        require(len(ends) == 1, "ts", None, needs)
    return family.each(lambda scene: require_times(scene, ts))[0]


def _at_all_times(value: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Values of cells, where other scenes have them over time too."""
    value = np.asarray(value)
    more = (1,) * (len(shape) - value.ndim)
    return np.broadcast_to(value.reshape(value.shape + more), shape)


def columns_of_family(found: list[SceneColumns], scenes: list[Scene]) -> Columns:
    """Columns of all scenes, `scene` in front; a column that one lacks is NaN there.

    What is told of a cell in one and over time in another is over time in all. Laws are
    columns too, filled up with NaN: they differ in length.
    """
    names = dict.fromkeys(name for one in found for name in one.columns)
    columns: Columns = {}
    for name in names:
        given = [one.columns[name] for one in found if name in one.columns]
        dims, longest = max(given, key=lambda column: len(column[0]))
        none = dims, np.full(np.shape(longest), np.nan)
        some = [one.columns.get(name, none) for one in found]
        values = [_at_all_times(v, np.shape(longest)) for _, v in some]
        columns[name] = (("scene", *dims), np.stack(values))
    for name, dim in LAW_DIMS.items():
        rows = [np.asarray(one.laws.get(name, ()), dtype=float) for one in found]
        room = max(row.size for row in rows)
        if room:
            filled = [np.pad(r, (0, room - r.size), constant_values=np.nan) for r in rows]
            columns[name] = (("scene", dim), np.stack(filled))
    columns["parts"] = (("scene",), np.array([exact_text(scene) for scene in scenes]))
    return columns
