"""Which loop jobs go through: the narrow one where few have a long way, or nothing else."""

import numpy as np

from frictionjax.wiggly.job_queue import Jobs, Legs
from frictionjax.wiggly.lane import Cells
from frictionjax.wiggly.lanes import NARROW, WIDTH, Room, _kind, _Loops, _wells

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


def test_few_jobs_take_a_wide_loop_that_is_there_until_it_costs_more():
    known = loops(WIDTH)
    found = [known.width_for(PROGRAM, FEW, 1500.0) for _ in range(5)]
    assert found == [WIDTH, WIDTH, NARROW, NARROW, NARROW]
    assert known.width_for(PROGRAM, FEW, 100.0) == WIDTH
    assert loops(WIDTH).width_for(PROGRAM, FEW, 2e5) == NARROW


def test_wells_on_the_way_are_counted_in_each_cells_own_periods():
    cells = Cells(np.array([0.1, 1e-3]), *[None] * (len(Cells._fields) - 1))
    nothing = np.zeros(2)
    jobs = Jobs(np.array([0.0, 1.0]), *[nothing] * 3, np.array([0, 2]), np.array([2, 3]))
    legs = {name: np.zeros(3) for name in Legs._fields}
    legs |= {"guide0": np.array([0.0, 1.0, 0.5]), "guide1": np.array([1.0, 0.5, 1.5])}
    assert _wells(cells, jobs, Legs(**legs)) == 15 + 1000
