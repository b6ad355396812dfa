"""Heights that lie far from all others: marks, heights, or asked about."""

import numpy as np
import pytest

from frictionjax.measured.samples import HeightSamples
from frictionjax.measured.sentinels import without_sentinels

EMPTY = np.empty((0, 0), int)


def sorted_out(values, outliers=None):
    rows = np.atleast_2d(values)
    samples = HeightSamples(np.arange(rows.shape[1]), rows, [], EMPTY, EMPTY)
    return without_sentinels(samples, outliers)


BASE = 300 * np.sin(np.arange(400) / 6)
PLACES = ([50], [50, 51, 120, 200])


@pytest.mark.parametrize("places", PLACES)
@pytest.mark.parametrize(
    ("mark", "level"),
    [(0, 5000), (-1, 5000), (-99, 5000), (-1e4, 0), (1e6, 0), (1e10, 0), (2000, 0)],
)
def test_heights_that_lie_alone_are_asked_about(mark, level, places):
    values = BASE + level
    values[places] = mark
    with pytest.raises(ValueError, match=f"row 0, sample 50 = .*: {len(places)} in all"):
        sorted_out(values)
    assert (
        np.flatnonzero(np.isnan(sorted_out(values, "missing").heights)).tolist() == places
    )
    assert np.array_equal(sorted_out(values, "keep").heights[0], values)


@pytest.mark.parametrize("places", PLACES)
@pytest.mark.parametrize(
    ("mark", "scale"),
    [
        (-999, 1),
        (9999.999, 1),
        (2147483.648, 1),
        (-32.768, 0.06),
        (-32768, 60),
        (999999, 1),
    ],
)
def test_well_known_marks_are_missing(mark, scale, places):
    values = scale * BASE
    values[places] = mark
    found = sorted_out(values)
    assert np.flatnonzero(np.isnan(found.heights)).tolist() == places
    assert f"as are {len(places)} in all" in found.notes[0]


def steep(shape):
    """A surface with something tall on it."""
    rng = np.random.default_rng(2)
    values, rows = BASE.copy(), rng.normal(size=(100, 400))
    if shape == "map":
        rows[50, 50:53], rows[51, 51] = (5, 60, 7), 50
        return rows
    if shape == "levels":
        return np.where(np.arange(400) % 40 < 20, 0, 1000.0) + rng.normal(size=400)
    bumps = {"scratch": [-400, -2000, -5000, -2200, -300], "particle": [3000, 9000, 4000]}
    bumps["clipped"] = [700, 9000, 9000, 9000, 650]
    bump = np.array(bumps[shape])
    values[100 : 100 + bump.size] += bump
    return values


@pytest.mark.parametrize("shape", ["scratch", "particle", "clipped", "map", "levels"])
def test_scratches_and_particles_are_heights(shape):
    found = sorted_out(steep(shape))
    assert not np.isnan(found.heights).any()
    assert found.notes == []


def test_what_lies_alone_on_both_sides():
    values = BASE.copy()
    values[[7, 90]] = -1e4, 1e4
    with pytest.raises(ValueError, match=r"sample 7 = .*2 in all lie alone, all others in"):
        sorted_out(values)


OPPOSITE = (
    {400: 25, 650: -30},
    {400: 25, 650: -25},
    {400: 1e4, 650: -30, 120: 40},
    {400: 1e4, 650: -30, 120: 40, 800: -2e3, 30: 7},
)


@pytest.mark.parametrize("spikes", OPPOSITE)
def test_spikes_on_opposite_sides_do_not_hide_each_other(spikes):
    values = 0.66 * np.sin(np.arange(1000) / 12)
    least, greatest = values.min(), values.max()
    for place, height in spikes.items():
        values[place] = height
    with pytest.raises(ValueError, match=f"{len(spikes)} in all lie alone") as told:
        sorted_out(values)
    assert str(told.value).endswith(f"all others in [{least:.6g}, {greatest:.6g}]")
    found = sorted_out(values, "missing").heights
    assert np.flatnonzero(np.isnan(found)).tolist() == sorted(spikes)


def test_a_scratch_stays_where_a_spike_on_the_other_side_goes():
    values = 0.66 * np.sin(np.arange(1000) / 12)
    values[650:653] = -2, -30, -3  # a flank on a scale that the spike must not set
    values[400] = 25
    found = sorted_out(values, "missing").heights
    assert np.flatnonzero(np.isnan(found)).tolist() == [400]
