"""A prediction's plan serves the sweep that follows it, and no other one."""

import numpy as np

import frictionjax as fx
from frictionjax.wiggly import integrate_cells, plans_ahead, workload

TS = np.linspace(0.0, 3.0, 7)
CELLS = np.array([0.05, 0.02]), np.array([1.0, 1.0])
ASKED = 1e-3, "auto"


def scene():
    return fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        3.0,
    )


def counted(monkeypatch):
    """Lists the eps of every plan that is made."""
    made, plan = [], plans_ahead.planned

    def planned(tables, path, eps, *rest):
        made.append(eps.tolist())
        return plan(tables, path, eps, *rest)

    monkeypatch.setattr(plans_ahead, "planned", planned)
    return made


def test_a_sweep_goes_by_the_plan_of_its_prediction(monkeypatch):
    alone = integrate_cells(scene(), *CELLS, TS, *ASKED)
    made, known = counted(monkeypatch), scene()
    workload(known, *CELLS, TS.size, *ASKED)
    found = integrate_cells(known, *CELLS, TS, *ASKED)
    assert len(made) == 1
    for column, expected in zip(found, alone, strict=True):
        np.testing.assert_array_equal(column, expected)


def test_other_cells_and_later_sweeps_are_planned_anew(monkeypatch):
    made, known = counted(monkeypatch), scene()
    workload(known, *CELLS, TS.size, *ASKED)
    integrate_cells(known, 0.5 * CELLS[0], CELLS[1], TS, *ASKED)
    integrate_cells(known, *CELLS, TS, *ASKED)  # the plan was taken by the first
    integrate_cells(scene(), *CELLS, TS, *ASKED)
    assert made == [[0.05, 0.02], [0.025, 0.01], [0.05, 0.02], [0.05, 0.02]]
