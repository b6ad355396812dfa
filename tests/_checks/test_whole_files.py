"""Files are written whole or not at all, and whoever fails to write says which one."""

import errno
import os
from pathlib import Path

import pytest

import frictionjax as fx
from frictionjax._checks import naming, write_whole
from frictionjax.design.common.heights import write_heights

SINE = fx.profiles.Sine(0.1)
SCENE = fx.Scene(
    SINE, fx.bristles.Homothetic(1.0), fx.supports.Spring(1.0), fx.loads.Ramp(1.0), 1.0
)
TRACE = fx.Trace([0.0, 1.0, 2.0, 3.0], z=[0.0, 1.0, 2.0, 3.0])
WRITERS = {
    "text": lambda path: write_whole(path, "h\u00f6he\n"),
    "bytes": lambda path: write_whole(path, b"data"),
    "scene": lambda path: fx.save_scene(SCENE, path),
    "trace": TRACE.to_csv,
    "heights": lambda path: write_heights(path, SINE, 1e-3, 64),
}


@pytest.fixture
def full(monkeypatch, tmp_path):
    """Half of what is written there fits; what JAX keeps of its programs elsewhere does."""
    write_bytes = Path.write_bytes

    def half(path, data):
        if tmp_path not in path.parents:
            return write_bytes(path, data)
        write_bytes(path, data[: len(data) // 2])
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_bytes", half)


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.parametrize("before", [None, "what was there"])
def test_a_full_disk_leaves_what_was_there(name, before, tmp_path, full):
    path = tmp_path / "file"
    if before is not None:
        path.write_text(before)
    with pytest.raises(OSError, match="No space left") as found:
        WRITERS[name](path)
    assert found.value.filename == str(path)
    assert found.value.errno == errno.ENOSPC
    assert [p.name for p in tmp_path.iterdir()] == ([] if before is None else ["file"])
    assert before is None or path.read_text() == before


@pytest.mark.parametrize("name", WRITERS)
def test_a_file_is_written_over_and_keeps_its_mode(name, tmp_path):
    path = tmp_path / "file"
    path.write_text("what was there, longer than all of the others" * 100)
    path.chmod(0o640)
    WRITERS[name](path)
    assert b"what was there" not in path.read_bytes()
    assert path.stat().st_mode & 0o777 == 0o640
    assert list(tmp_path.iterdir()) == [path]


def test_links_and_devices_are_written_to(tmp_path):
    (tmp_path / "link").symlink_to(tmp_path / "file")
    write_whole(tmp_path / "link", "text")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "file").read_text() == "text"
    write_whole(os.devnull, "text")
    assert not Path(os.devnull).is_file()


@pytest.mark.parametrize("name", WRITERS)
def test_a_folder_that_is_not_there_is_named(name, tmp_path):
    with pytest.raises(FileNotFoundError) as found:
        WRITERS[name](tmp_path / "none" / "file")
    assert found.value.filename == str(tmp_path / "none" / "file")


def test_names_that_are_known_stay():
    with pytest.raises(OSError, match="gone") as found, naming("other"):
        raise OSError(errno.EIO, "gone", "this one")
    assert found.value.filename == "this one"
