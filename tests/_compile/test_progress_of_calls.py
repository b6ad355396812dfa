"""Calls that take more than two seconds say what is under way, where they are asked to."""

import inspect
from importlib import import_module

import numpy as np
import pytest
import xarray as xr

import frictionjax as fx

SURFACE = fx.profiles.Sine(0.1)
BRISTLE = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
PARTS = SURFACE, BRISTLE, fx.supports.Spring(1.0), fx.loads.Sine(1.0488, 3.0), 3.0
SCENE = fx.Scene(*PARTS)
NOISY = fx.Scene(*PARTS, effects=(fx.effects.Noise(0.01),))
TARGET = fx.Target(BRISTLE, 0.1, -0.08)
TIMES = np.linspace(0.0, 3.0, 4)
_CELLS = (("gamma", "eps"), np.zeros((1, 2)))
SWEPT = xr.Dataset(  # nothing is made of it: calls end where their line begins
    dict.fromkeys(("sup_error", "status", "strip_excess", "z"), _CELLS),
    coords={"gamma": [1.0], "eps": [0.1, 0.05], "time": 0.0},
    attrs={"accuracy": 1e-3},
)
# Where the line begins, and a call of little work before it.
CALLS = {
    "fit_angle": ("design.bristle.angle", (SURFACE, BRISTLE), {"ratio": 1.3}),
    "nap": ("contact.nap_effect", (SURFACE, BRISTLE), {}),
    "solve": ("wiggly.trajectory", (SCENE, 0.1), {}),
    "certify": ("certificate.certification", (SCENE, 0.1, 1.0, [0, 3], [0, 0]), {}),
    "predict_cost": ("cost.prediction", (SCENE, 0.1), {"measure": False}),
    "explain": ("explain.explanation", (SCENE, 0.1, 1.0), {}),
    "study": ("studies.convergence_study", (SWEPT,), {}),
    "fit_profile": ("design.surface.fit", (TARGET,), {}),
    "steady_slide": ("design.slide.slide_friction", (SURFACE, BRISTLE, 0.02), {}),
    "check_design": ("design.slide.slide_friction", (SURFACE, BRISTLE), {}),
    "work_precision": ("cost.measurement", (SCENE,), {}),
    "fit_slide": ("design.slide.bristle_fit", (SURFACE, BRISTLE, 0.02), {"ratio": 1.3}),
    "fit_slide_profile": ("design.slide.surface_fit", (TARGET, 0.02), {}),
    "design_map": ("design.ensembles.maps", (BRISTLE,), {}),
    "tolerance": ("design.ensembles.manufacturing", (SURFACE, BRISTLE, {"angle": 0.1}), {}),
    "ensemble": ("stochastic.ensembles", (NOISY, 0.1, 1.0, TIMES, 4, 0), {}),
    "friction_curve": ("rate_dependence.curves", (SCENE, 0.1, 0.1), {}),
    "friction_curve of noise": ("rate_dependence.curves", (NOISY, 0.1, 0.1), {}),
}


class BegunError(Exception):
    pass


@pytest.mark.parametrize("name", CALLS)
def test_a_call_has_a_line_where_it_is_asked_for(name, monkeypatch):
    module, given, options = CALLS[name]
    name = name.partition(" ")[0]
    call = getattr(fx, name)

    def begun(*args):
        raise BegunError(*args)

    # By its path: functions have the names of some packages.
    monkeypatch.setattr(import_module(f"frictionjax.{module}"), "waiting", begun)
    with pytest.raises(BegunError) as silent:
        call(*given, **options)
    line = {"check_design": "steady_slide"}.get(name, name)
    assert silent.value.args == (line, False)
    with pytest.raises(BegunError) as told:
        call(*given, **options, progress=True)
    assert told.value.args == (line, True)
    with pytest.raises(ValueError, match="progress = 'yes': needs True or False"):
        call(*given, **options, progress="yes")


def test_no_line_is_the_default_everywhere_but_of_fits_to_traces():
    found = {
        name: inspect.signature(value).parameters["progress"].default
        for name, value in ((name, getattr(fx, name)) for name in fx.__all__)
        if callable(value) and "progress" in inspect.signature(value).parameters
    }
    assert found.pop("fit_trace") is True
    asked = {name.partition(" ")[0] for name in CALLS} | {"sweep", "order_cost"}
    assert found == dict.fromkeys(asked, False)


def test_a_pilot_has_the_bar_of_its_sweep(monkeypatch):
    def begun(*args, progress, **options):
        raise BegunError(progress)

    monkeypatch.setattr("frictionjax.cost.order_accuracy.sweep", begun)
    for shown in (False, True):
        with pytest.raises(BegunError) as told:
            fx.order_cost(SCENE, [0.1, 0.01], measure=False, progress=shown)
        assert told.value.args == (shown,)
