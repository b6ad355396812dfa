"""Files that are written whole or not at all, and failures that say which file it was."""

import contextlib
import errno
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

# A disk, what a user may write, and what one file may hold.
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


@contextlib.contextmanager
def naming(name: Any) -> Iterator[None]:
    """Say where writing failed: what is raised where bytes are written names no file."""
    try:
        yield
    except OSError as error:
        if error.filename is not None or error.errno is None:
            raise
        raise OSError(error.errno, os.strerror(error.errno), str(name)) from None


def write_whole(path: Any, content: str | bytes | memoryview) -> None:
    """Write a file, text in UTF-8, so that a failure leaves what was there before.

    Beside it first, then moved: a device, a pipe or a link is written to itself, and so is
    a file in a folder that may not be changed. Raises `OSError` with the file's name.
    """
    path = Path(path)
    data = content.encode("utf-8") if isinstance(content, str) else content
    with naming(path):
        if not _can_be_moved_to(path):
            path.write_bytes(data)
            return
        part = path.with_name(f".{os.urandom(8).hex()}-part")  # of this thread alone
        try:
            with naming(path):
                part.write_bytes(data)
            with contextlib.suppress(FileNotFoundError):
                part.chmod(path.stat().st_mode)
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)


def _can_be_moved_to(path: Path) -> bool:
    plain = not path.is_symlink() and (path.is_file() or not path.exists())
    there = path.is_file() and not os.access(path, os.W_OK)  # replacing it needs no leave
    return plain and not there and os.access(path.parent, os.W_OK)
