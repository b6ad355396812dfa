"""Targets that bounds on the surface leave hardly any room for, and how much they leave."""

import re

import numpy as np
import pytest
from designs import HOMOTHETIC, slopes_of

import frictionjax as fx
from frictionjax.design.surface.status import ProfileStatus

TIGHT = [  # of witnesses with 0.3 to 0.5% to spare
    # The radius is not felt: by the program of other bounds.
    (
        {"largest_amplitude": 0.005, "smallest_radius": 1e-3, "harmonics": 4},
        0.0408,
        -0.0556,
    ),
    ({"largest_amplitude": 0.005, "harmonics": 4}, 0.0408, -0.0556),
    ({"smallest_radius": 3.0, "harmonics": 4}, 0.05735, -0.03442),
    ({"largest_amplitude": 0.008, "harmonics": 6}, 0.1495, -0.1495),
    ({"largest_amplitude": 0.01, "harmonics": 16}, 0.3213, -0.0839),
    ({"smallest_radius": 2.0, "harmonics": 16}, 0.05745, -0.01151),
]


@pytest.mark.parametrize(
    ("bounds", "plus", "minus"),
    [TIGHT[0], *(pytest.param(*tight, marks=pytest.mark.slow) for tight in TIGHT[1:])],
)
def test_what_bounds_hardly_leave_room_for_is_met(bounds, plus, minus):
    fit = fx.fit_profile(fx.Target(HOMOTHETIC, plus, minus), starts=2, **bounds)
    assert fit.status is ProfileStatus.MET, fit.message
    assert fit.largest_error < 1e-9
    assert fit.bending_bound <= fit.bending_energy < 1.001 * fit.bending_bound
    heights = np.ptp(slopes_of(fit.profile, order=-1))
    assert heights <= bounds.get("largest_amplitude", np.inf)
    steepest = np.max(np.abs(slopes_of(fit.profile, order=1)))
    assert steepest <= 1 / bounds.get("smallest_radius", 1e-9)
    # One start more than asked for; of the others none says that this is out of reach.
    assert fit.starts[0].number == 2
    assert fit.history.loss.shape[0] == 3
    assert {start.status.name for start in fit.starts[1:]} == {"NOT_FOUND"}


@pytest.mark.parametrize(
    "bounds",
    [TIGHT[0][0], *(pytest.param(TIGHT[i][0], marks=pytest.mark.slow) for i in (1, 2))],
)
def test_the_share_said_to_be_reachable_is_met_and_no_more(bounds):
    slopes = np.array([0.09, -0.06])

    def fitted(share):
        target = fx.Target(HOMOTHETIC, *(share * slopes).tolist())
        return fx.fit_profile(target, starts=2, **bounds)

    beyond = fitted(1.0)
    assert beyond.status.name in ("TOO_HIGH", "TOO_SHARP")
    said = float(re.search(r"([\d.]+) of the slopes asked for", beyond.message)[1])
    assert 0.5 < said < 1
    assert fitted(0.999 * said).success
    more = fitted(1.002 * said)
    assert not more.success
    assert "0.99" in more.message


@pytest.mark.slow
def test_two_targets_that_differ_get_the_compromise_and_not_a_bound():
    """0.0404 and 0.0412 in the mean: as steep as the tightest of the surfaces above."""
    targets = [fx.Target(HOMOTHETIC, plus, -0.0556) for plus in (0.0404, 0.0412)]
    fit = fx.fit_profile(targets, starts=2, **TIGHT[0][0])
    assert fit.status is ProfileStatus.CONTRADICTORY
    assert 0.0404 < fit.coefficients[0].rho_plus < 0.0412


@pytest.mark.slow
def test_a_free_bristle_is_met_too_where_bounds_leave_little_room():
    part = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    free = {"free": "stiffness", "bounds": {"stiffness": (0.99, 1.0)}}
    target = fx.Target(part, 0.0408, -0.0556)
    fit = fx.fit_profile(target, starts=2, **free, **TIGHT[0][0])
    assert fit.success, fit.message
    assert np.ptp(slopes_of(fit.profile, order=-1)) <= 0.005
