"""Frames go by time and by the way gone, and are as many as asked for."""

import numpy as np

from frictionjax.plot.moving.frames import frame_rows


def staircase(slips, rows):
    """A tip that rests, and slips by 1 within a two-hundredth of the time between."""
    time = np.linspace(0, slips, rows)
    within = time - np.floor(time)
    place = np.floor(time) + np.clip((within - 0.5) * 200, 0, 1)
    return time, np.stack([place, time], axis=1), (within > 0.5) & (within < 0.505)


def test_slips_are_seen():
    time, places, slipping = staircase(5, 20_001)
    rows = frame_rows(time, places, 80)
    assert slipping[rows].sum() >= 12
    by_time = np.linspace(0, time.size - 1, 80).astype(int)
    assert slipping[by_time].sum() <= 5
    assert np.max(np.diff(time[rows])) < 5 / 30


def test_none_is_twice_and_both_ends_are_there():
    rng = np.random.default_rng(3)
    for size, count in ((500, 80), (81, 80), (1000, 2), (300, 299)):
        time = np.cumsum(rng.random(size) ** 9)
        places = np.cumsum(rng.random((size, 2)) ** 20, axis=0)
        places[size // 2 :] += 100  # a jump: one frame, however far
        rows = frame_rows(time, places, count)
        assert rows.size == count
        assert np.all(np.diff(rows) >= 1)
        assert (rows[0], rows[-1]) == (0, size - 1)


def test_after_a_jump_frames_go_on_as_before():
    time = np.linspace(0, 1, 1001)
    places = np.stack([time, np.where(time > 0.5, 50.0, 0.0)], axis=1)
    steps = np.diff(frame_rows(time, places, 41))
    assert np.max(steps) <= 27
    assert np.sort(steps)[2] >= 24  # the frame in the jump cuts one in two


def test_all_rows_where_there_are_no_more():
    time = np.linspace(0, 1, 7)
    rows = frame_rows(time, np.zeros((7, 2)), 80)
    np.testing.assert_array_equal(rows, np.arange(7))
    rest = frame_rows(time, np.zeros((7, 2)), 3)  # nothing moves: by time alone
    np.testing.assert_array_equal(rest, [0, 3, 6])


def test_rows_that_stand_still_are_parted_too():
    time = np.linspace(0, 1, 100)
    time[1:90] = time[1]
    rows = frame_rows(time, np.zeros((100, 2)), 50)
    assert rows.size == 50
    assert np.all(np.diff(rows) >= 1)
