"""Wells of several tops: equal ones are shorter wells, lower ones are not forgotten."""

import numpy as np
import pytest
from scipy.special import ai_zeros
from slides import PLACES, RHO, sine, wells

from frictionjax.slide_laws.exponents import averaged_force, fold_force, limit_orbit
from frictionjax.slide_laws.orbit import periodic_orbit
from frictionjax.slide_laws.well_force import well_force

COARSE = np.unique(
    np.concatenate([np.arange(1024) / 1024, (0.3331 + PLACES[PLACES < 0.07]) % 1])
)


def several(count, sign=1):
    """Tops of one height, the first at 0.3331; the table is dense beside that one only."""
    return well_force(
        COARSE,
        sign * RHO * np.cos(2 * np.pi * count * (COARSE - 0.3331)),
        0.0 * COARSE,
        sign,
    )


@pytest.mark.parametrize(("drop", "drag"), [(1e-3, 1e-2), (1e-5, 1e-4), (1e-9, 1e-7)])
@pytest.mark.parametrize("count", [2, 3])
def test_wells_of_several_equal_tops_are_shorter_wells(count, drop, drag):
    shorter = periodic_orbit(wells(sine), np.array(drop / count), np.array(drag))
    found = periodic_orbit(several(count), np.array(drop), np.array(drag))
    size = max(float(shorter.largest), -float(shorter.smallest))
    for value, exact in zip(found, shorter, strict=True):
        assert value == pytest.approx(exact, abs=0.02 * size)
    assert found.largest == pytest.approx(shorter.largest, rel=0.03, abs=0)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("count", [2, 3])
def test_limits_of_several_equal_tops_are_those_of_shorter_wells(count, sign):
    well, one = several(count, sign), np.ones(1)
    assert averaged_force(well, 1e-4 * one) == pytest.approx(
        averaged_force(wells(sine), 1e-4 * one), rel=0.02
    )
    found = limit_orbit(well, one, one, 1.0).force
    assert found.smallest == pytest.approx(-1 / count, abs=1e-3)
    assert found.mean == pytest.approx(-0.5 / count, abs=1e-3)
    delay, order = fold_force(well, one, one, 1.0)
    assert delay == pytest.approx(
        fold_force(wells(sine), one, one / count, 1.0)[0], rel=0.03
    )
    assert order == pytest.approx(4 / 3)


@pytest.mark.parametrize("tilt", [0.1, 0.5, 1.0, 2.0])
def test_tops_that_are_equal_by_symmetry_delay_a_fall_alike(tilt):
    """Found by a polynomial the second height is off by its error, which is no plateau."""
    top = np.arccos(-tilt / 4) / (2 * np.pi)

    def force(y):
        return -RHO * (tilt * np.cos(2 * np.pi * y) + np.cos(4 * np.pi * y))

    beside = PLACES[(PLACES < 0.07) | (PLACES > 0.93)]
    table = np.unique(np.concatenate([np.arange(1024) / 1024, (top + beside) % 1]))
    well, one = well_force(table, force(table), 0.0 * table, 1), np.ones(1)
    bend = 0.5 * RHO * (2 * np.pi) ** 2 * (4 - tilt**2 / 4)
    delay, _ = fold_force(well, one, one, 1.0)
    assert delay == pytest.approx(-ai_zeros(1)[0][0] * bend ** (-1 / 3), rel=0.05)
    flat = averaged_force(well, 1e-6 * one)
    assert flat == pytest.approx((2e-6 * np.pi) ** 2 / bend, rel=0.05, abs=0)


@pytest.mark.parametrize("fine", [8, 16, 24])
def test_heights_within_the_error_of_a_polynomial_are_equal(fine):
    """Two tops of one height with ripples of a few places of the table."""

    def force(y):
        turn = 2 * np.pi * (y - 0.3331)
        return RHO * (np.cos(2 * turn) + 0.2 * np.cos(fine * turn))

    well, one = well_force(COARSE, force(COARSE), 0.0 * COARSE, 1), np.ones(1)
    bend = 0.5 * RHO * (2 * np.pi) ** 2 * (4 + 0.2 * fine**2)
    flat = averaged_force(well, 1e-6 * one)
    assert flat == pytest.approx((2e-6 * np.pi) ** 2 / bend, rel=0.05, abs=0)


@pytest.mark.parametrize("lower", [1e-6, 1e-4, 1e-2, 0.3])
@pytest.mark.parametrize(("drop", "drag"), [(1e-4, 1e-3), (1e-6, 1e-5)])
def test_a_lower_top_is_as_well_known_as_from_a_dense_table(lower, drop, drag):
    def force(y):
        turn = 2 * np.pi * (y - 0.3331)
        return RHO * (np.cos(2 * turn) + 0.5 * lower * np.cos(turn))

    dense = np.unique(
        np.concatenate([PLACES, (PLACES + 0.3331) % 1, np.arange(2048) / 2048])
    )
    found, truth = (
        periodic_orbit(
            well_force(at, force(at), 0.0 * at, 1), np.array(drop), np.array(drag)
        )
        for at in (COARSE, np.unique(np.concatenate([dense, (0.3331 + 0.5 + dense) % 1])))
    )
    assert found.largest == pytest.approx(truth.largest, rel=0.02, abs=0)
    assert found.smallest == pytest.approx(truth.smallest, rel=0.02, abs=0)
