"""Mechanics of tips with mass."""

import numpy as np
import pytest
from tips_with_mass import mass_for, massive_scene

import frictionjax as fx

EPS = 0.05


def test_energies_gain_what_is_put_in_less_what_is_lost():
    scene = massive_scene(mass_for(10.0, EPS, 1.0))
    ts = np.linspace(0, 3, 6001)
    solution = fx.solve(scene, EPS, ts=ts, accuracy=1e-5)
    found = fx.mechanics(scene, solution, EPS)
    assert found.energy_kinetic.attrs["units"] == "J"
    energy = found.energy_support + found.energy_bristle + found.energy_kinetic
    power = np.asarray(found.power)
    put_in = np.concatenate(
        [[0.0], np.cumsum(0.5 * np.diff(ts) * (power[1:] + power[:-1]))]
    )
    left = energy - energy[0] - put_in + found.dissipation
    assert np.max(np.abs(left)) < 1e-3 * float(found.dissipation[-1])
    assert float(found.energy_kinetic.max()) > 0.05 * EPS * 0.1


def test_a_solution_without_velocity_is_refused():
    scene = massive_scene(1e-4)
    plain = scene.replace(effects=())
    solution = fx.solve(plain, EPS, ts=[0.0, 1.0])
    assert solution.velocity is None
    with pytest.raises(ValueError, match=r"without velocity.*: needs that of this scene"):
        fx.mechanics(scene, solution, EPS)
    assert "energy_kinetic" not in fx.mechanics(plain, solution, EPS)
    assert "energy_kinetic" not in fx.mechanics(scene, fx.solve_limit(scene))
