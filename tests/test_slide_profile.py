"""Surfaces whose steady slide, and not only its limit, has the forces asked for."""

import equinox as eqx
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.design.fit_status import FitStatus

SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
TARGET = fx.Target(SLANTED, 0.03, -0.025)
EPS = 1e-2


@pytest.mark.parametrize("force", ["mean", "peak"])
def test_the_slide_has_the_forces_that_the_limit_misses(force):
    found = fx.fit_slide_profile(TARGET, EPS, force=force)
    assert found.success
    assert found.status == FitStatus.OK
    assert found.fit.success
    slide = fx.steady_slide(found.profile, SLANTED, EPS)
    shown = getattr(slide, f"{force}_plus"), getattr(slide, f"{force}_minus")
    assert np.allclose(shown, [0.03, -0.025], rtol=2e-6)
    assert np.max(np.abs(found.residuals)) < 1e-6
    assert f"{force} forces [ 0.03  -0.025] N at eps = 0.01: found in" in found.message
    missed = fx.steady_slide(found.limit.profile, SLANTED, EPS)
    off = float(getattr(missed, f"{force}_plus")) / 0.03 - 1
    assert abs(off) > 5e-3
    assert float(found.limit.coefficients[0].rho_plus) == pytest.approx(0.03, rel=1e-9)


def test_what_no_limit_design_leads_to_says_so():
    found = fx.fit_slide_profile(TARGET._replace(rho_plus=0.3, rho_minus=-0.001), EPS)
    assert not found.success
    assert found.status == FitStatus.UNREACHABLE
    assert "not reached; the last design shows [" in found.message
    assert "not reachable with this number of harmonics" in found.message
    assert np.max(np.abs(found.residuals)) > 1e-3


def test_a_slide_that_is_not_found_leaves_it_unknown(monkeypatch):
    from frictionjax.design import slide_profile

    real = slide_profile.steady_slide

    def lost(*args):
        slide = real(*args)
        return eqx.tree_at(lambda s: s.code_plus, slide, np.asarray(3))

    monkeypatch.setattr(slide_profile, "steady_slide", lost)
    found = fx.fit_slide_profile(TARGET, EPS)
    assert found.status == FitStatus.UNKNOWN
    assert "not every value could be evaluated" in found.message


def test_wrong_arguments_are_named():
    with pytest.raises(ValueError, match="target = 'list': needs one"):
        fx.fit_slide_profile([TARGET], EPS)
    with pytest.raises(ValueError, match="force = 'last': needs 'mean' or 'peak'"):
        fx.fit_slide_profile(TARGET, EPS, force="last")
    with pytest.raises(ValueError, match="eps = -1: needs eps > 0"):
        fx.fit_slide_profile(TARGET, -1.0)
    with pytest.raises(ValueError, match=r"target.rho_plus = -0\.03: needs rho_plus > 0"):
        fx.fit_slide_profile(TARGET._replace(rho_plus=-0.03), EPS)
