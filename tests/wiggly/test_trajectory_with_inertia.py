"""`solve` of scenes with inertia, and of those without."""

import subprocess
import sys

import numpy as np
import pytest
from tips_with_mass import massive_scene

import frictionjax as fx

ABSENT = """
import sys
import frictionjax.explain, frictionjax.studies, frictionjax.sweeps
import frictionjax.wiggly.trajectory
assert not [name for name in sys.modules if name.startswith("frictionjax.wiggly.inertial")]
"""


def test_a_scene_without_it_loads_nothing_of_it():
    done = subprocess.run([sys.executable, "-c", ABSENT], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_other_effects_go_with_it():
    plain = massive_scene(1e-4)
    mass = plain.effects
    leading = plain.replace(effects=(*mass, fx.effects.LeadingOrder()))
    array = plain.replace(effects=(*mass, fx.effects.RigidArray([0.0], [2.0])))
    ts = np.linspace(0, 1, 11)
    found = [fx.solve(s, 0.05, ts=ts) for s in (plain, leading, array)]
    assert all(one.ok for one in found)
    apart = np.abs(found[0].z - found[1].z)
    assert 0 < np.max(apart) < 0.05
    # Twice the potential is the potential of a bristle that pulls twice as hard.
    strong = fx.bristles.VerticalSpring(2.0, 2.0, 1.0)
    doubled = fx.solve(plain.replace(bristle=strong), 0.05, ts=ts)
    np.testing.assert_allclose(found[2].z, doubled.z, atol=1e-6)


def test_energies_are_left_out_where_not_asked_for():
    found = fx.solve(massive_scene(1e-4), 0.05, ts=[0.5], dissipation=False)
    assert found.dissipation is None
    assert found.residual is None
    assert found.velocity.shape == (1,)


@pytest.mark.parametrize("ts", [[0.0], [0.0, 0.0, 1.0], [1.0, 1.0]])
def test_times_at_the_start_and_twice(ts):
    found = fx.solve(massive_scene(1e-4), 0.05, ts=ts)
    whole = fx.solve(massive_scene(1e-4), 0.05, ts=[0.0, 1.0])
    known = dict(zip((0.0, 1.0), np.asarray(whole.z), strict=True))
    np.testing.assert_allclose(found.z, [known[t] for t in ts], atol=1e-9)
