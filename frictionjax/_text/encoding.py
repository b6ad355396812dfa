"""Which text the bytes of a file are."""

import codecs

from .._checks import require

_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),  # begins as UTF-16 does
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)


def decoded(data: bytes, *more: str) -> str:
    """The text of a file's bytes, without the ^Z that ends one of DOS.

    By its byte order mark; UTF-16 without one by its zeros; UTF-8; or else one byte a
    letter, as Windows writes in the west, or as `more` encodings have it.

    Raises `ValueError` for bytes that are no text.
    """
    encodings = [name for mark, name in _MARKS if data.startswith(mark)][:1]
    encodings = encodings or _by_zeros(data[:4096]) or ["utf-8", "cp1252", *more]
    for encoding in encodings:
        try:
            return data.decode(encoding).rstrip("\x1a")
        except UnicodeDecodeError as error:
            refused = f"byte {error.start + 1}: needs text in {encoding.upper()}"
    raise ValueError(refused)


def _by_zeros(data: bytes) -> list[str]:
    """UTF-16: letters and digits have their zero on one side."""
    even, odd = data[::2].count(0), data[1::2].count(0)
    if not even and not odd:
        return []
    enough = max(even, odd) >= 0.4 * len(data[::2])
    require(enough, "file", "bytes", "text, and no binary file")
    return ["utf-16-be" if even > odd else "utf-16-le"]
