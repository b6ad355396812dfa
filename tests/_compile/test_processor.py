"""What tells processors apart."""

import platform
import subprocess
from types import SimpleNamespace

from frictionjax._compile import processor as of_processor
from frictionjax._compile.processor import processor

CORES = """processor\t: 0
model name\t: One
cpu MHz\t\t: 1234.5
flags\t\t: fpu avx2

processor\t: 1
model name\t: One
flags\t\t: fpu avx2
"""


def test_what_it_can_do_counts_and_its_clock_does_not(tmp_path, monkeypatch):
    monkeypatch.setattr(of_processor, "_CORES", tmp_path / "cpuinfo")
    found = []
    for text in (
        CORES,
        CORES.replace("1234.5", "2000.0"),
        CORES.replace("avx2", "avx512f"),
        CORES.replace("One", "Two"),
    ):
        (tmp_path / "cpuinfo").write_text(text)
        found.append(processor())
    assert found[0] == found[1]
    assert len(set(found)) == 3


def test_a_mac_is_asked_for_its_name(tmp_path, monkeypatch):
    monkeypatch.setattr(of_processor, "_CORES", tmp_path / "none")
    monkeypatch.setattr(platform, "system", lambda: "Darwin")
    answer = SimpleNamespace(stdout="Apple M2")
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: answer)
    assert "Apple M2" in processor()


def test_a_process_asks_twice_and_hears_the_same():
    assert processor() == processor() != ""
