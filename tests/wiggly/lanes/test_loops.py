"""Which loop jobs go through: the narrow one where few have a long way, or nothing else."""

import threading
import time
import tomllib
from pathlib import Path

import jax
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.model import tabulated_scene
from frictionjax.wiggly.enclosure.marching import _blocks
from frictionjax.wiggly.lanes import loops as module
from frictionjax.wiggly.lanes.lane import LaneCells
from frictionjax.wiggly.lanes.loops import (
    LOADER,
    Room,
    _kind,
    _Loops,
    _wells,
    loop_times,
    prepare,
)
from frictionjax.wiggly.lanes.queue import Lanes, Segments, Tables, run_queue
from frictionjax.wiggly.lanes.settings import SETTINGS
from frictionjax.wiggly.plan import lane_scene
from frictionjax.wiggly.settings import SETTINGS as SWEEP_SETTINGS

FIXED = np.ones(3), "scheme"
FEW, LARGE = Room(1, 7, 14), Room(64, 2048, 4096)
NARROW, WIDE = (True, SETTINGS.narrow), (True, SETTINGS.width)
BARE = False, SETTINGS.narrow


def loops(own, room=LARGE):
    """Loops of which one is compiled."""
    known, kind = _Loops(), (_kind(FIXED), own)
    known._known[kind] = {room: None}
    known._done.add((kind, room))
    return known


def test_the_fastest_loop_is_taken_where_none_is_there():
    times = {NARROW: 1.0, WIDE: 4.0}
    assert _Loops().choose(FIXED, FEW, times) == NARROW
    assert loops(NARROW).choose(FIXED, FEW, times) == NARROW
    assert loops(WIDE, Room(1, 2, 4)).choose(FIXED, FEW, times) == NARROW


@pytest.mark.parametrize(("wells", "taken"), [(500.0, NARROW), (5000.0, BARE)])
def test_the_first_loop_has_sums_unless_they_cost_much(wells, taken):
    assert _Loops().choose(FIXED, FEW, {BARE: wells, NARROW: 1.5 * wells}) == taken


@pytest.mark.parametrize(
    ("there", "best"), [(WIDE, NARROW), (NARROW, WIDE), (NARROW, BARE)]
)
def test_a_loop_that_is_there_serves_until_it_costs_more(monkeypatch, there, best):
    known, loaded = loops(there), []
    monkeypatch.setattr(known, "load", lambda program, room: loaded.append((program, room)))
    times = {best: 100.0, there: 400.0}
    for asked in range(1, 6):
        assert known.choose(FIXED, FEW, times) == there  # nobody waits for it
        assert len(loaded) == (asked > 1)
    assert loaded == [((*FIXED, *best), FEW)]
    assert loops(there).choose(FIXED, FEW, {best: 1e4, there: 1e5}) == best
    known._done.add(((_kind(FIXED), best), LARGE))
    assert known.choose(FIXED, FEW, times) == best


def test_one_that_is_compiled_already_is_waited_for():
    """Where no other is there that serves."""
    known = _Loops()
    known._known[_kind(FIXED), WIDE] = {LARGE: None}
    assert known.choose(FIXED, FEW, {NARROW: 1.0, WIDE: 4.0}) == WIDE


@pytest.mark.parametrize(
    ("there", "summed", "narrow", "begun"),
    [
        (None, False, False, [(False, SETTINGS.width)]),
        (None, False, True, [NARROW]),
        (WIDE, False, True, []),
        (NARROW, True, False, []),
        (BARE, True, False, [WIDE]),
        (BARE, False, True, []),
    ],
)
def test_no_loop_is_prepared_where_one_serves(monkeypatch, there, summed, narrow, begun):
    known, loaded = loops(there, Room(*SETTINGS.room)), []
    monkeypatch.setattr(known, "load", lambda program, room: loaded.append(program))
    monkeypatch.setattr(module, "_LOOPS", known)
    prepare(*FIXED, FEW, summed, narrow)
    assert loaded == [(*FIXED, *own) for own in begun]


def test_wells_one_after_the_other_are_counted_in_each_cells_own_periods():
    cells = LaneCells(np.array([0.1, 1e-3]), *[None] * (len(LaneCells._fields) - 1))
    nothing = np.zeros(2)
    jobs = Lanes(np.array([0.0, 1.0]), *[nothing] * 3, np.array([0, 2]), np.array([2, 3]))
    legs = {name: np.zeros(3) for name in Segments._fields}
    legs |= {"guide0": np.array([0.0, 1.0, 0.5]), "guide1": np.array([1.0, 0.5, 1.5])}
    assert _wells(cells, jobs, Segments(**legs)) == pytest.approx([15, 1000])
    legs["guide1"][0] = 200.0  # 2005 wells of the first job
    assert _wells(cells, jobs, Segments(**legs)) == pytest.approx([2005, 1000])


def test_work_and_not_the_number_of_jobs_decides_on_the_loop():
    """Few jobs, or many of which few take long."""
    narrow, wide = loop_times(10.0, 20 * 10.0)
    assert narrow < wide
    narrow, wide = loop_times(10.0, 600 * 10.0)
    assert narrow > 1.5 * wide
    narrow, wide = loop_times(2000.0, 2000.0 + 600 * 10.0)
    assert narrow < 0.5 * wide


@pytest.mark.parametrize("width", [SETTINGS.narrow, SETTINGS.width])
def test_loops_are_compiled_as_one_function(width):
    """XLA makes a list of kernels of a loop with a scatter, for two threads at once."""
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Ramp(1.0, 0.0),
        duration=1.0,
    )
    fixed = lane_scene(tabulated_scene(scene, 0.1)), SWEEP_SETTINGS.tableau, True, width
    columns = len(LaneCells._fields), len(Lanes._fields), len(Segments._fields)
    tables = [np.ones((n, w)) for n, w in zip(FEW, columns, strict=True)]
    program = jax.make_jaxpr(
        lambda *rows: run_queue._fn(*fixed, Tables(*rows, waiting=np.asarray(1)))
    )
    text = str(program(*tables))
    assert "while" in text
    assert "scatter" not in text


def idle(work, blocks, workers=2):
    """Share of the time that lanes idle, at best: as the longest job of a block goes on."""
    rows = [work[block] for block in blocks]
    wall = sum(max(row.sum() / (workers * SETTINGS.width), row.max()) for row in rows)
    return 1 - work.sum() / (workers * SETTINGS.width * wall)


@pytest.mark.parametrize("longest", [1e3, 3e3, 1e5])
def test_lanes_do_not_wait_for_the_longest_job_of_every_block(longest):
    """One block for all has the same work in it, and fewer reports."""
    work = np.concatenate([np.full(160, longest), np.full(2400, 1e3)])
    blocks = _blocks(work, np.full(work.size, 2), 2)
    assert idle(work, blocks) <= 0.01 + idle(work, [np.arange(work.size)])
    assert len(blocks) >= {1e3: 10, 3e3: 5, 1e5: 1}[longest]
    assert sorted(np.concatenate(blocks)) == list(range(work.size))


def test_blocks_have_room_in_the_smallest_loop():
    """But where most lanes would then idle."""
    rng = np.random.default_rng(0)
    work, legs = rng.exponential(3.0, 60_000), rng.integers(2, 6, 60_000)
    _, jobs, room = SETTINGS.room
    blocks = _blocks(work, legs, 2)
    assert len(blocks) > 5
    for block in blocks:
        assert block.size <= 2 * jobs
        assert legs[block].sum() <= 2 * room
    assert idle(work, blocks) < 0.01
    many = np.full(400, 100)
    assert max(len(b) for b in _blocks(np.full(400, 1e4), many, 2)) < 400
    equal = np.full(400, 1e4)
    blocks = _blocks(equal, 10 * many, 2)  # 29 have room: lanes would idle
    assert [len(block) for block in blocks] == [192, 208]


def test_a_few_jobs_are_one_block_and_none_are_none():
    assert _blocks(np.zeros(0), np.zeros(0, int), 2) == []
    assert len(_blocks(np.full(3, 1e6), np.full(3, 2), 2)) == 1


def test_a_version_that_copies_whole_tables_is_left_out():
    project = Path(__file__).parents[3] / "pyproject.toml"
    needed = tomllib.loads(project.read_text())["project"]["dependencies"]
    assert "jaxlib!=0.11.1" in needed


def test_twice_the_stops_take_twice_the_time():
    """A version of jaxlib copied the table of all stops whenever a lane wrote into it."""
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        duration=3.0,
    )

    def spent(count):
        """CPU seconds for so many stops, the better of two."""
        tries = []
        for _ in range(2):
            for thread in threading.enumerate():  # a loop may be compiled beside
                if LOADER in thread.name:
                    thread.join()
            before = time.process_time()
            fx.solve(scene, 1e-3, ts=np.linspace(0, 3, count), method="resolved")
            tries.append(time.process_time() - before)
        return min(tries)

    spent(16_000)  # compiled
    assert spent(16_000) < 3 * spent(8_000)
