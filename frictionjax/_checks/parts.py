"""What a part of a scene is: data that its constructor checks, and that can change."""

import contextlib
import dataclasses
import inspect
import weakref
from collections.abc import Iterator
from typing import Any, ClassVar, NamedTuple, Self, TypeVar

import equinox as eqx
import jax

from .arguments import in_64_bits, is_concrete, is_known, require
from .higher_floors import floor_above
from .shown_parts import notebook_text, part_text

_PartT = TypeVar("_PartT", bound="Part")
_OURS = __name__.partition(".")[0]


class ByIdentity:
    """Notes on modules, which cannot be keys of a dictionary, as long as they live.

    What is made of a module's leaves (`eqx.tree_at`, `jax.tree.map`) or a copy has none. An
    attribute beside the fields would be seen by `vars(part)`.
    """

    def __init__(self) -> None:
        self._notes: dict[int, tuple[weakref.ref, Any]] = {}

    def get(self, thing: Any) -> Any:
        """The note on a thing; None without one."""
        known, note = self._notes.get(id(thing), (None, None))
        return note if known is not None and known() is thing else None

    def put(self, thing: Any, note: Any) -> None:
        """Keep a note that does not refer to the thing itself."""
        key = id(thing)
        gone = weakref.ref(thing, lambda _: self._notes.pop(key, None))
        self._notes[key] = gone, note


_CHECKED = ByIdentity()


class Asked(NamedTuple):
    """Of an argument of a part: its `unit`, what is `allowed`, whether it is a `row`."""

    unit: str
    allowed: str
    row: bool = False

    def __str__(self) -> str:
        return f"{self.unit}, {self.allowed}"


class Part(eqx.Module):
    """Base of profiles, bristles, supports, loads and potentials.

    An implementer checks numbers in `__check_init__` and nowhere else, and converts them
    with `eqx.field(converter=...)`: a part that was made of another one's leaves has seen
    no constructor, and `checked` does these two where it is used.
    """

    asked: ClassVar[dict[str, Asked]] = {}
    """Of arguments that scene files give: unit and range, as `frictionjax scenes` says."""
    _stored: ClassVar[dict[str, str]] = {}
    """Fields of constructor arguments that have another name."""

    def __check_init__(self):
        mark_checked(self)  # equinox runs it last, after those of subclasses

    def replace(self, **changes: Any) -> Self:
        """The part with other constructor arguments, by name, built anew.

        Raises `ValueError` for names that there are not, and as the constructor does.

        >>> scene.bristle.replace(angle=0.5)
        SlantedSpring(stiffness=1, rest_length=2.4, height=1, angle=0.5)
        """
        known = asked_names(type(self), changes)
        given = {name: getattr(self, self._stored.get(name, name)) for name in known}
        return type(self)(**(given | changes))

    def __replace__(self, **changes: Any) -> Self:
        return self.replace(**changes)

    def __repr__(self) -> str:
        return part_text(self, asked_names(type(self), {}))

    def _repr_html_(self) -> str:
        return notebook_text(self, lambda: floor_above("io").part_table(self))


def asked_names(kind: type, changes: dict[str, Any]) -> list[str]:
    """Names of a constructor's arguments; raises `ValueError` for a change of no such."""
    parameters = inspect.signature(kind.__init__).parameters
    # A stored field may be an argument too: so `dataclasses.replace` builds a part.
    fields = getattr(kind, "_stored", {}).values()
    known = [name for name in parameters if name != "self" and name not in fields]
    for name, value in changes.items():
        allowed = f"an argument of {kind.__name__}, one of {', '.join(known)}"
        require(name in known, f"{kind.__name__}.replace: {name}", value, allowed)
    return known


def is_foreign(part: Any) -> bool:
    """Whether its class is written outside the library: nobody knows what it keeps to."""
    return type(part).__module__.partition(".")[0] != _OURS


def mark_checked(thing: eqx.Module) -> None:
    """Remember that its constructor has looked at its numbers, if it could."""
    if in_64_bits() and is_concrete(thing):
        _CHECKED.put(thing, True)


def is_checked(thing: eqx.Module) -> bool:
    """Whether it is as a constructor has seen it."""
    return _CHECKED.get(thing) is not None


def checked(part: _PartT) -> _PartT:
    """The part as its constructor would make it of its numbers, which may be changed ones.

    Costs nothing where nothing was changed. Traced numbers cannot be looked at.
    Raises `ValueError` as the constructor does.
    """
    if is_checked(part) or not is_known(part) or not in_64_bits():
        return part
    with eagerly(part):
        part = _converted(part)
        for module in _modules(part):
            _check(module)
    return part


@contextlib.contextmanager
def eagerly(*trees: Any) -> Iterator[None]:
    """Compute with known numbers now, inside a caller's `jit` too."""
    if is_concrete(*trees):
        yield
    else:
        with jax.ensure_compile_time_eval():
            yield


def _converted(part: _PartT) -> _PartT:
    """With the converters run that its constructor runs: `tree_at` puts in a plain 2."""
    changes = {}
    for field in dataclasses.fields(part):
        old = getattr(part, field.name)
        convert = field.metadata.get("converter")
        new = _converted(old) if isinstance(old, Part) else convert(old) if convert else old
        if new is not old:
            changes[field.name] = new
    return exchanged(part, changes) if changes else part


def exchanged(thing: Any, changes: dict[str, Any]) -> Any:
    """A copy with other fields, unchecked."""
    copy = object.__new__(type(thing))
    for field in dataclasses.fields(thing):
        value = changes.get(field.name, getattr(thing, field.name))
        object.__setattr__(copy, field.name, value)
    return copy


def _modules(module: eqx.Module) -> Iterator[eqx.Module]:
    """It and those inside it that no constructor has looked at, inner ones first."""
    if is_checked(module):
        return
    for field in dataclasses.fields(module):
        inner = getattr(module, field.name, None)
        if isinstance(inner, eqx.Module):
            yield from _modules(inner)
    yield module


def _check(module: eqx.Module) -> None:
    """As equinox does after a constructor."""
    for kind in type(module).__mro__:
        if "__check_init__" in vars(kind):
            vars(kind)["__check_init__"](module)
