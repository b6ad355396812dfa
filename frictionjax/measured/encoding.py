"""Which text the bytes of a file are, where they are text."""

import codecs
import re

_MARKS = (  # UTF-32's mark begins like UTF-16's
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_CONTROL = re.compile("[\x00-\x08\x0e-\x19\x1b-\x1f]")  # ^Z ends a text of DOS


def decoded_text(data: bytes) -> str | None:
    """The text of a file; None where it is none.

    By its byte order mark; UTF-16 without one by its zeros; UTF-8; or else one byte a
    letter, as Windows writes in the west.
    """
    encodings = [name for mark, name in _MARKS if data.startswith(mark)][:1]
    for encoding in encodings or [*_without_mark(data), "utf-8", "cp1252", "latin-1"]:
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        return None if _CONTROL.search(text) else text.rstrip("\x1a")
    return None


def _without_mark(data: bytes) -> list[str]:
    """UTF-16: half of the bytes of numbers are zeros, all in odd or in even places."""
    some = data[:400]
    even, odd = some[::2].count(0), some[1::2].count(0)
    if max(even, odd) < 0.4 * len(some[::2]) or min(even, odd) > 0:
        return []
    return ["utf-16-be" if even else "utf-16-le"]
