"""Every hard scene against a reference that shares no line with the library."""

import numpy as np
import pytest
from asked import named
from catalogue import HARD

import frictionjax as fx

ACCURACY = 1e-3
_LATE = (
    "1e6 slips, gamma 1/2",
    "1e6 slips in 3 s",
    "eps 1e-8",
    "slips shorter than floats",
    "soft support",
    "gamma 4",
    "gamma 0.05",
    "stiff support",
    "1e6 slips",
)


@pytest.mark.parametrize("name", named(slow=_LATE))
def test_values_against_the_independent_reference(name):
    """Values of every method that can be asked; finite, and with a status that is good."""
    one = HARD[name]
    expected, scene = one.truth(one, one.ts), one.build()
    outside = ~expected.in_slip
    assert outside.sum() >= 45
    for method in one.methods:
        found = fx.solve(scene, one.eps, one.gamma, one.ts, ACCURACY, method)
        assert found.ok, found.status.message
        for values in (found.z, found.dissipation, found.residual):
            assert np.all(np.isfinite(values))
        error = np.abs(np.asarray(found.z) - expected.z)[outside] / one.eps
        assert error.max() < ACCURACY, method
        lost = np.abs(np.asarray(found.dissipation) - expected.dissipation)[outside]
        assert lost.max() < ACCURACY * expected.dissipation[-1], method
        # Ten times closer than the status asks for.
        assert float(found.residual[-1]) < 0.005 * expected.dissipation[-1], method


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::frictionjax.wiggly.equation.status.FailedCells")
def test_eps_over_seven_decades_in_one_batch():
    scene = HARD["kinks and plateaus"].build()
    eps = 0.97 * np.geomspace(1e-1, 1e-8, 8)
    data = fx.sweep(scene, eps, [0.75, 1.0, 2.0, 4.0], np.linspace(0.0, 3.0, 61))
    assert int(data.status.sel(gamma=[0.75, 1.0, 2.0]).max()) == 0
    # A viscosity of 1e-25: a force that rounds by 1e-16 N, squared over it, is a residual.
    assert set(data.status.values.ravel()) <= {fx.Status.OK, fx.Status.UNBALANCED}
    assert int(data.status.sel(gamma=4.0).where(data.eps > 1e-5, 0).max()) == 0
    assert np.all(np.isfinite(data.z))
    # Theorem 1: within some eps of the limit; at gamma < 1 within eps^gamma.
    bound = 5 * eps ** np.minimum(1.0, data.gamma.values)[:, None]
    assert np.all((data.sup_error.values < bound) | (data.status.values != 0))
    assert np.all(np.abs(data.z - data.z_limit).max("time").values < bound)
