"""Which loop jobs go through: the narrow one where few have a long way, or nothing else."""

import numpy as np
import pytest

from frictionjax.wiggly.job_queue import Jobs, Legs
from frictionjax.wiggly.lane import Cells
from frictionjax.wiggly.lanes import (
    NARROW,
    WIDTH,
    Room,
    _kind,
    _Loops,
    _wells,
    loop_times,
)
from frictionjax.wiggly.rounds import longest_alone

PROGRAM = np.ones(3), "scheme", True
FEW, LARGE = Room(1, 7, 14), Room(64, 2048, 4096)


def loops(width, room=LARGE):
    """Loops of which one is compiled."""
    known, kind = _Loops(), _kind((*PROGRAM, width))
    known._known[kind] = {room: None}
    known._done.add((kind, room))
    return known


def test_few_jobs_take_the_narrow_loop_where_none_is_there():
    assert _Loops().width_for(PROGRAM, FEW, 1.0) == NARROW
    assert loops(NARROW).width_for(PROGRAM, FEW, 1.0) == NARROW
    assert loops(WIDTH, Room(1, 2, 4)).width_for(PROGRAM, FEW, 1.0) == NARROW


def test_few_jobs_take_a_wide_loop_that_is_there_until_it_costs_more(monkeypatch):
    known, loaded = loops(WIDTH), []
    monkeypatch.setattr(known, "load", lambda program, room: loaded.append((program, room)))
    for asked in range(1, 6):
        assert known.width_for(PROGRAM, FEW, 400.0) == WIDTH  # nobody waits for it
        assert len(loaded) == (asked > 1)
    assert loaded == [((*PROGRAM, NARROW), FEW)]
    known._done.add((_kind((*PROGRAM, NARROW)), LARGE))
    assert known.width_for(PROGRAM, FEW, 100.0) == NARROW
    assert loops(WIDTH).width_for(PROGRAM, FEW, 2e5) == NARROW


def test_wells_one_after_the_other_are_counted_in_each_cells_own_periods():
    cells = Cells(np.array([0.1, 1e-3]), *[None] * (len(Cells._fields) - 1))
    nothing = np.zeros(2)
    jobs = Jobs(np.array([0.0, 1.0]), *[nothing] * 3, np.array([0, 2]), np.array([2, 3]))
    legs = {name: np.zeros(3) for name in Legs._fields}
    legs |= {"guide0": np.array([0.0, 1.0, 0.5]), "guide1": np.array([1.0, 0.5, 1.5])}
    assert _wells(cells, jobs, Legs(**legs)) == pytest.approx([15, 1000])
    legs["guide1"][0] = 200.0  # 2005 wells of the first job
    assert _wells(cells, jobs, Legs(**legs)) == pytest.approx([2005, 1000])


def test_work_and_not_the_number_of_jobs_decides_on_the_loop():
    """Few jobs, or many of which few take long."""
    narrow, wide = loop_times(10.0, 20 * 10.0)
    assert narrow < wide
    narrow, wide = loop_times(10.0, 600 * 10.0)
    assert narrow > 2 * wide
    narrow, wide = loop_times(2000.0, 2000.0 + 600 * 10.0)
    assert narrow < 0.5 * wide


def test_the_longest_jobs_go_beside_many_short_ones():
    """Three long lanes would keep two wide loops waiting; one loop is as good for few."""
    short = np.full(6000, 10.0)
    assert 3 <= longest_alone(np.append([2000.0, 1900.0, 1800.0], short)) < 100
    few = np.append([2000.0, 1900.0, 1800.0], np.full(600, 10.0))
    assert longest_alone(few) == 0  # two narrow loops are as good
    assert longest_alone(np.append([11.0] * 3, short)) == 0
    assert longest_alone(np.full(8, 500.0)) == 0
    assert longest_alone(np.array([700.0])) == 0
    # More than a narrow loop holds: the rest stays where it is.
    assert longest_alone(np.append(np.full(100, 2000.0), short)) == 0
