"""Wells from a table of a period: straight flanks, however long, are flat on both sides."""

import numpy as np
import pytest
from slides import PLACES

from frictionjax.slide_laws.exponents import averaged_force, threshold
from frictionjax.slide_laws.well_force import well_force

RHO, CORNER = 0.1, 0.02


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("share", [0.3, 0.8])
@pytest.mark.parametrize("begin", [0.0, 0.37])
def test_a_flank_longer_than_half_a_period_is_a_straight_flank(sign, share, begin):
    """One side saw nothing but the flank, and no law of a sawtooth was found."""
    along = (PLACES - begin) % 1.0
    depth = np.clip(np.minimum(along - share, 1.0 - along) / CORNER, 0.0, 1.0)
    force = sign * RHO * (1.0 - 2.0 * depth**2 * (3.0 - 2.0 * depth))
    well = well_force(PLACES, force, 0.0 * PLACES, sign)
    assert threshold(well) == 1.0  # p is infinite
    assert well.rho == pytest.approx(RHO)
    # All the time goes by on the flank: share/x = 1/drag.
    drag = np.array([1e-9])
    assert averaged_force(well, drag) == pytest.approx(share * drag, rel=0.01)
