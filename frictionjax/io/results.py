"""Results as JSON: a class declares its document, which writes and reads it."""

import json
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from .._checks import Outcome, as_jax
from .documents import array_of, checked_document, plain, read_document
from .registry import part_entry, part_of


def _same(value: Any) -> Any:
    return value


class Form(NamedTuple):
    """How a value becomes an entry of a document, and the value again.

    `read`: None for what is written for people alone. `absent`: the value for documents of
    earlier versions, made of their entries; without it the entry is needed. `argument`: of
    the result's constructor, where it has another name than the entry.
    """

    write: Callable[[Any], Any] = _same
    read: Callable[[Any], Any] | None = _same
    absent: Callable[[dict[str, Any]], Any] | None = None
    argument: str | None = None

    def or_else(self, absent: Callable[[dict[str, Any]], Any]) -> "Form":
        """The same, with a value where the entry is not there.

        None and (), where that is the value, are not written.
        """
        return self._replace(absent=absent)


def _number(value: Any) -> Any:
    if value is None:
        return float("nan")
    return float(value) if isinstance(value, str) else value  # "inf"


def _integers(rows: Any) -> np.ndarray:
    return np.array(rows, dtype=int)


AS_IS = Form()
TOLD = Form(read=None)
NUMBER = Form(read=_number)
ARRAY = Form(read=array_of)
INTEGERS = Form(read=_integers)
BOOLS = Form(read=lambda rows: np.array(rows, dtype=bool))
LEAF = Form(read=lambda rows: as_jax(array_of(rows)))
CODES = Form(read=lambda rows: as_jax(_integers(rows)))
PART = Form(part_entry, part_of)


def by_name(kind: type[Outcome]) -> Form:
    """An outcome by its name."""
    return Form(lambda outcome: outcome.name, lambda name: kind[name])


def several(form: Form) -> Form:
    """A tuple of one form, as a list."""
    write, read = form.write, form.read
    assert read is not None
    return Form(
        lambda values: [write(value) for value in values],
        lambda entries: tuple(read(entry) for entry in entries),
    )


def record(kind: Callable[..., Any], names: Any, form: Form, **others: Form) -> Form:
    """An object with these fields, `others` in forms of their own; those None left out."""
    forms = {name: others.get(name, form) for name in names}

    def write(value: Any) -> dict[str, Any]:
        known = {name: getattr(value, name) for name in names}
        return {k: forms[k].write(v) for k, v in known.items() if v is not None}

    def read(entry: dict[str, Any]) -> Any:
        return kind(**_read(forms, entry))

    return Form(write, read)


def nested(kind: Any) -> Form:
    """Another result, as its whole document."""
    document: Document = kind.document
    return Form(document.entries, lambda entries: kind(**document.fields(entries)))


def _read(forms: Mapping[str, Form], entries: dict[str, Any]) -> dict[str, Any]:
    found = {}
    for name, form in forms.items():
        if form.absent is not None and entries.get(name) is None:
            found[form.argument or name] = form.absent(entries)
        elif form.read is not None and name in entries:
            found[form.argument or name] = form.read(entries[name])
    return found


class Document(NamedTuple):
    """The document of a result: its kind, and the forms of its entries in their order.

    Of a number that is not finite JSON holds null for NaN, a text for infinity; null for
    both where not `infinite`.
    """

    kind: str
    forms: Mapping[str, Form]
    infinite: bool = True

    def entries(self, result: Any) -> dict[str, Any]:
        """Of a result, as JSON has them."""
        known: dict[str, Any] = {"kind": self.kind}
        for name, form in self.forms.items():
            value = getattr(result, name)
            missing = value is None or (isinstance(value, tuple) and not value)
            if not (missing and form.absent):
                known[name] = form.write(value)
        return plain(known, self.infinite)

    def text(self, result: Any) -> str:
        """The JSON of a result; numbers keep all digits."""
        return json.dumps(self.entries(result), indent=1)

    def fields(self, entries: Any) -> dict[str, Any]:
        """Arguments of the result's constructor.

        Raises `ValueError` for entries of another kind, or that lack some.
        """
        needed = {k for k, form in self.forms.items() if form.read and not form.absent}
        return _read(self.forms, checked_document(entries, self.kind, needed))

    def parse(self, source: Any) -> dict[str, Any]:
        """`fields` of a JSON text, or of the file at a path.

        Raises `ValueError` for what is no such JSON, inside of entries too.
        """
        try:
            return self.fields(read_document(source))
        except (LookupError, TypeError) as problem:
            raise ValueError(f"source: not a whole fit ({problem!r})") from None
