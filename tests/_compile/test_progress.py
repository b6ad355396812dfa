"""A line on standard error says what is under way, and goes when it is done."""

import threading
import time

import jax
import pytest

from frictionjax._compile import progress
from frictionjax.design.trace import programs as trace_programs


@pytest.fixture
def hurried(monkeypatch):
    monkeypatch.setattr(progress, "_PATIENCE", 0.02)
    monkeypatch.setattr(progress, "_EVERY", 0.02)


def test_what_takes_long_is_told_while_nothing_is_said(hurried, capsys):
    with progress.waiting("work", True) as tell:
        tell("compiling")
        time.sleep(0.2)
        tell("second part")
        time.sleep(0.2)
    told = capsys.readouterr().err
    assert "work: compiling, 00:00 so far" in told
    assert "work: second part" in told
    assert told.endswith("\r")  # the line is gone
    assert threading.active_count() == len(threading.enumerate())


def test_compilation_is_told_apart(hurried, monkeypatch, capsys):
    monkeypatch.setattr(progress, "_WORTH", 1e-6)
    with progress.waiting("work", True):
        time.sleep(0.1)
        jax.jit(lambda x: jax.numpy.sin(x) + 0.7182)(1.0).block_until_ready()
        time.sleep(0.1)
    before, _, after = capsys.readouterr().err.partition("s of it compiling")
    assert after
    assert "so far" in before  # of the time before nothing is said
    with progress.progress_bar("cells", True) as bar:
        bar.update(0.5)
        assert "compiling" not in capsys.readouterr().err
        jax.jit(lambda x: jax.numpy.cos(x) + 0.7182)(1.0).block_until_ready()
        bar.update(0.5)
        bar.refresh()
    assert "s of it compiling" in capsys.readouterr().err


def test_a_bar_ends_where_it_is_full(capsys):
    """Shares of 1 add up to more, by rounding: bars warned, and were done in -00:00."""
    with progress.progress_bar("runs", True) as bar:
        for _ in range(48):
            bar.update(1 / 48)
        assert bar.n == pytest.approx(1.0, rel=1e-12)
        assert bar.n <= 1.0
    told = capsys.readouterr().err
    assert "clamping" not in told
    assert "-00:00" not in told
    assert "100%" in told


@pytest.mark.parametrize("shown", [True, False])
def test_what_is_done_at_once_says_nothing(shown, capsys):
    with progress.waiting("work", shown) as tell:
        tell("compiling")
    assert capsys.readouterr().err == ""


def test_nothing_is_shown_unasked(hurried, capsys):
    with progress.waiting("work", False):
        time.sleep(0.1)
    assert capsys.readouterr().err == ""


def test_the_line_goes_where_work_fails(hurried, capsys):
    def work():
        with progress.waiting("work", True):
            time.sleep(0.1)
            raise ValueError("bad")

    with pytest.raises(ValueError, match="bad"):
        work()
    assert capsys.readouterr().err.endswith("\r")


def test_programs_compile_one_after_the_other_and_the_first_is_waited_for():
    class Problem:
        ts = penalty = trace_programs.np.ones(3)
        calls: list = []

        def _replace(self, ts):
            assert not ts.any()
            return self

        def run(self, numbers):
            time.sleep(0.05)
            self.calls.append("run")

        def run_bumps(self, numbers):
            self.calls.append("bumps")

    with trace_programs.compiled_beside(Problem()) as ready:
        ready()
        assert Problem.calls[0] == "run"
        time.sleep(0.05)
    assert Problem.calls == ["run", "bumps"]
