"""How closely the lanes of a bracket have met: in way, in a slip in time."""

import numpy as np
import pytest

from frictionjax.numerics import rows_of
from frictionjax.wiggly.enclosure.closeness import meetings_at, wells_between
from frictionjax.wiggly.lanes.queue import SegmentEnds, Segments


def measured(wells=0.1, paces=(1.0, 1.0), path=1.0, ahead=1, fastest=1.0, pace=np.inf):
    """Two lanes at a stop, `wells` apart, that move at `paces` where the path does at 1.

    `pace`: of the fast slide they are on.
    """
    none = np.zeros(2)
    place, speed = np.array([0.0, wells]), np.array(paces)
    ends = SegmentEnds(np.array([3.0, 3.0]), place, speed, *[none] * 11)
    slope = np.full(2, path)
    segments = Segments(none, none, none, none, slope, slope, none, none)
    found = meetings_at(ends, segments, np.array([0]), np.array([ahead]), fastest, pace)
    return rows_of(found, 0)


def test_the_way_counts_where_the_tip_moves_as_the_path_does():
    assert measured().gap == pytest.approx(0.1)
    assert measured(wells=1.1).gap == pytest.approx(1.1)


def test_in_a_slip_the_time_counts():
    assert measured(paces=(1000.0, 1.0)).gap == pytest.approx(1e-3)


def test_slips_of_a_fast_slide_are_those_at_its_own_pace():
    """Its first wells take longer than the path's: three times the path is a slip there."""
    assert measured(paces=(3.0, 3.0)).gap == pytest.approx(0.1)
    assert measured(paces=(3.0, 3.0), pace=0.1).gap == pytest.approx(0.1 / 3)
    assert measured(paces=(3.0, 3.0), pace=10.0).gap == pytest.approx(0.1)
    assert measured(paces=(0.2, 0.2), pace=0.1).shift == pytest.approx(0.05)


def test_near_a_fold_the_time_counts_as_a_shift():
    assert measured(paces=(0.1, 1.0)).shift == pytest.approx(1.0)
    assert measured(paces=(1e-9, 1.0)).shift == pytest.approx(10.0)


def test_a_known_start_leaves_no_gap():
    assert measured(ahead=-1).gap == 0


def test_on_a_path_that_rests_for_good_nothing_is_a_slip():
    # Any speed was infinitely faster than the path's, and every bracket closed.
    assert measured(paces=(1e5, 1e5), path=0.0, fastest=0.0).gap == pytest.approx(0.1)
    slow = measured(paces=(0.1, 0.1), path=0.0, fastest=1.0)
    assert slow.gap == pytest.approx(0.1)


def test_wells_between_keep_the_digits_of_tips():
    # A tip added to the well first is lost: 1e8 wells are spaced by 1.5e-8.
    well, tip = 1e8, 3.3e-11
    assert wells_between(well, 0.0, well - 2, tip) + 2 == pytest.approx(tip, rel=1e-4)
    assert wells_between(well, tip, well, 2 * tip) == pytest.approx(tip, rel=1e-12)
