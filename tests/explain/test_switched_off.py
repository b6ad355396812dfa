"""Where the load turns on a fold the higher order is switched off, and measured."""

import numpy as np
import pytest
from outside_slips import states_outside_slips, times_about

import frictionjax as fx
from frictionjax.called_for import higher_order, setting_of
from frictionjax.explain import switched_off
from frictionjax.explain.telling_times import telling_times
from frictionjax.io.example_scenes import example_text
from frictionjax.io.scene_files import parse_scene

EPS, GAMMA = 0.02, 0.5
SPRING = parse_scene(example_text("vertical-spring"), "vertical-spring").scene
MEASURED = "switched off and measured: the load turns on a fold, t = 0.75 s"


def row_of(scene, gamma=GAMMA, eps=EPS):
    row = fx.explain(scene, eps, gamma).effects.sel(effect="higher order")
    return float(row.in_z), str(row.source.values)


@pytest.mark.slow  # every slip of two scenes
def test_where_the_load_turns_on_a_fold_what_is_told_is_measured_and_a_bound():
    """A tip without it slips late, by three times what the closed form tells."""
    times = times_about(SPRING, EPS)
    leading = SPRING.replace(effects=(fx.effects.LeadingOrder(),))
    pair = [states_outside_slips(s, GAMMA, EPS, times) for s in (SPRING, leading)]
    (z, calm), (other, still) = pair
    seen = np.max(np.abs(z - other)[calm & still])
    assert higher_order(setting_of(SPRING, EPS, GAMMA)).estimate.in_z < 0.5 * seen
    told, source = row_of(SPRING)
    assert source == MEASURED
    assert seen <= told <= 10 * seen
    # Of a scene that leaves it out already the same is told.
    assert row_of(leading)[0] == pytest.approx(told, rel=1e-3)


def test_elsewhere_nothing_is_solved(monkeypatch):
    monkeypatch.setattr(switched_off, "integrate_cells", None)
    told, source = row_of(SPRING, gamma=2.0)
    assert told == higher_order(setting_of(SPRING, EPS, 2.0)).estimate.in_z
    assert "measured" not in source


def test_where_a_solve_fails_the_closed_form_is_told_as_no_bound(monkeypatch):
    monkeypatch.setattr(switched_off, "integrate_cells", lambda **asked: None)
    told, source = row_of(SPRING)
    assert told == higher_order(setting_of(SPRING, EPS, GAMMA)).estimate.in_z
    assert source.endswith("no bound where the load turns on a fold, t = 0.75 s")


def test_mass_and_noise_are_not_in_what_is_measured(monkeypatch):
    asked = []
    monkeypatch.setattr(switched_off, "integrate_cells", lambda **a: asked.append(a))
    row_of(SPRING.replace(effects=(fx.effects.Inertia(1e-9),)))
    assert asked[0]["scene"].effects == ()
    assert asked[0]["phase"] is None


def test_however_much_is_told_it_is_measured_to_a_thousandth_of_eps(monkeypatch):
    found, asked = higher_order(setting_of(SPRING, EPS, GAMMA)), []
    far = found._replace(estimate=found.estimate._replace(in_z=50 * EPS))
    monkeypatch.setattr(switched_off, "higher_order", lambda at: far)
    monkeypatch.setattr(switched_off, "integrate_cells", lambda **a: asked.append(a))
    row_of(SPRING)
    assert asked[0]["accuracy"] == 1e-3


def test_each_bristle_of_an_array_is_measured_and_of_many_some(monkeypatch):
    asked = []

    def first(**told):
        asked.append(told)
        return None

    monkeypatch.setattr(switched_off, "integrate_cells", first)
    offsets = [0.0, 0.25, 1.25, 0.5]
    row_of(SPRING.replace(effects=(fx.effects.CompliantArray(offsets),)))
    np.testing.assert_allclose(asked[0]["phase"], [0.0, 0.25, 0.5])
    monkeypatch.setattr(switched_off, "_largest_change", lambda *told: 1e-9)
    many = (fx.effects.CompliantArray(np.linspace(0.0, 0.99, 50)),)
    told, source = row_of(SPRING.replace(effects=many))
    assert source.endswith("; no bound beyond 13 of 50 bristles, 2 of 2 turns")
    assert told == higher_order(setting_of(SPRING, EPS, GAMMA)).estimate.in_z


def test_a_line_of_progress_says_that_scenes_are_solved(monkeypatch):
    lines = []
    monkeypatch.setattr(switched_off, "integrate_cells", lambda **asked: None)
    at = setting_of(SPRING, EPS, GAMMA)
    switched_off.higher_order_told(at, lines.append)
    assert lines == ["solving with the higher order and without it"]


@pytest.mark.parametrize(("eps", "way"), [(EPS, "resolved"), (1e-8, "auto")])
def test_every_slip_is_solved_where_slips_are_fewer_than_times(monkeypatch, eps, way):
    asked = []
    monkeypatch.setattr(switched_off, "integrate_cells", lambda **a: asked.append(a))
    at = setting_of(SPRING, eps, GAMMA)
    times = telling_times(at, np.array([0.75]))
    switched_off._largest_change(at, times, 1e-6, np.zeros(1))
    assert [told["method"] for told in asked] == [way, way]
