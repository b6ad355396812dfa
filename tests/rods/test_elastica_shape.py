"""Shapes of bent rods."""

import numpy as np
import pytest

from frictionjax.rods import bent_between_hinges, bent_shape


@pytest.mark.parametrize("chord", [0.2, 0.5, 0.9, 0.999])
def test_it_is_as_long_as_the_rod_and_as_wide_as_its_chord(chord):
    along, across = bent_shape(1.4, chord * 1.4, 4001)
    pieces = np.hypot(np.diff(along), np.diff(across))
    assert np.sum(pieces) == pytest.approx(1.4, rel=1e-6)
    assert along[-1] - along[0] == pytest.approx(1.4 * chord, rel=1e-9)
    np.testing.assert_allclose(across[[0, -1]], 0, atol=1e-12)
    assert np.all(across[1:-1] > 0)


@pytest.mark.parametrize("chord", [0.3, 0.8])
def test_its_moment_is_that_of_its_thrust(chord):
    """`B theta' = -P y` at every point, and the energy `B/2 int theta'^2`."""
    stiffness, length = 0.15, 1.4
    along, across = bent_shape(length, chord * length, 20001)
    angle = np.unwrap(np.arctan2(np.diff(across), np.diff(along)))
    pieces = np.hypot(np.diff(along), np.diff(across))
    bend = np.diff(angle) / (0.5 * (pieces[1:] + pieces[:-1]))
    found = bent_between_hinges(stiffness, length, chord * length)
    moment = -float(found.thrust) * across[1:-1]
    np.testing.assert_allclose(stiffness * bend, moment, atol=2e-4 * np.max(-moment))
    energy = 0.5 * stiffness * np.sum(bend**2 * 0.5 * (pieces[1:] + pieces[:-1]))
    assert energy == pytest.approx(float(found.energy), rel=1e-3)


def test_a_rod_as_long_as_its_chord_is_straight():
    along, across = bent_shape(1.4, 1.4, 11)
    np.testing.assert_allclose(across, 0, atol=1e-12)
    np.testing.assert_allclose(np.sum(np.diff(along)), 1.4, rtol=1e-12)


@pytest.mark.parametrize("chord", [0.0, -1.0, 1.5])
def test_chords_that_no_rod_has_are_refused(chord):
    with pytest.raises(ValueError, match="chord = "):
        bent_shape(1.4, chord)
