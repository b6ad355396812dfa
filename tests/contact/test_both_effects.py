"""Both effects of the nap on one bristle."""

import numpy as np
import pytest
from rods_that_turn import turning_scene

import frictionjax as fx
from frictionjax.contact import nap_loops


@pytest.fixture(scope="module")
def loops():
    return nap_loops(turning_scene(duration=8.0), np.linspace(0, 8, 801))


def test_each_has_its_own_friction_both_ways(loops):
    law = fx.nap(turning_scene().profile, turning_scene().bristle)
    stiff = loops.sel(effect="geometric").force.values
    assert stiff.max() == pytest.approx(law.rho_with, rel=1e-9)
    assert stiff.min() == pytest.approx(-law.rho_against, rel=1e-9)
    bent = loops.sel(effect="energetic")
    turned = bent["mode"].values == -1
    assert bent.force.values[turned].min() == pytest.approx(-law.rho_flipped, rel=1e-9)
    assert loops.attrs["rho_against"] == law.rho_against
    assert loops.attrs["rho_flipped"] == law.rho_flipped


def test_around_a_loop_the_work_is_what_is_lost(loops):
    """From one turn of the load to that a period later, both in steady loops."""
    for name in ("geometric", "energetic"):
        one = loops.sel(effect=name).isel(time=slice(300, 701))
        z, force = one.z.values, one.force.values
        assert z[-1] == pytest.approx(z[0], abs=1e-9)
        work = np.sum(np.diff(z) * 0.5 * (force[1:] + force[:-1]))
        lost = float(one.dissipation[-1] - one.dissipation[0])
        assert work == pytest.approx(lost, rel=2e-3)


def test_a_scene_without_the_effect_is_refused():
    with pytest.raises(ValueError, match=r"scene\.effects = .none of NapFlip"):
        nap_loops(turning_scene().replace(effects=()))


def test_a_start_is_held_against_what_the_rod_withstands():
    """Not against the strip of the rod that keeps its nap, which is larger."""
    with pytest.raises(ValueError, match=r"scene\.z0 = 5: needs what the rod withstands"):
        nap_loops(turning_scene().replace(z0=5.0))
