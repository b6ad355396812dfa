"""Results draw themselves, into axes of the user's own too, and load nothing before."""

import gc
import io
import subprocess
import sys
import weakref

import jax
import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from rods_that_turn import ROD, SURFACE, turning_scene

import frictionjax as fx
from frictionjax.cost.order_accuracy import EpsGrid, OrderCost
from frictionjax.design.slide.slide_friction import SteadySlide

BRISTLE = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
SCENE = fx.Scene(SURFACE, BRISTLE, fx.supports.Spring(1.0), fx.loads.Sine(1.0488, 3.0), 3.0)
STILL = np.linspace(0.0, 3.0, 31)
SLIDE = SteadySlide(0.01, 0.1, -0.08, 0.12, -0.09, code_plus=0, code_minus=0)
GRID = EpsGrid(0.01, 1e-3, 6, 0.02, order=1.0, seconds=0.1, low=0.98, high=1.02, laid=7)
RESULTS = {
    "scene": lambda: SCENE,
    "friction": lambda: fx.friction(SCENE),
    "solve": lambda: fx.solve(SCENE, 1e-2, 1.0, np.linspace(0.0, 3.0, 4)),
    "solve_limit": lambda: fx.solve_limit(SCENE, STILL),
    "solve_limit of a rod": lambda: fx.solve_limit(turning_scene()),
    "certify": lambda: fx.certify(SCENE, 0.05, 1.0, STILL, 0.0 * STILL),
    "nap": lambda: fx.nap(SURFACE, ROD),
    "predict_cost": lambda: fx.predict_cost(SCENE, [1e-2, 1e-3], measure=False),
    "fit_angle": lambda: fx.fit_angle(SURFACE, BRISTLE, ratio=1.3),
    "steady_slide": lambda: SLIDE,
    "explain": lambda: fx.explain(SCENE, 0.01, 1.0),
    "order_cost": lambda: OrderCost([GRID], GRID, success=True, message="one"),
}


@pytest.mark.parametrize("name", RESULTS)
def test_every_result_draws_itself_alone_and_into_axes(name):
    result = RESULTS[name]()
    figure = result.plot()
    assert isinstance(figure, Figure)
    figure.savefig(io.BytesIO(), format="png", dpi=40)
    mine = Figure()
    left, right = mine.subplots(1, 2)
    before = dict(mpl.rcParams)
    assert result.plot(ax=right) is right
    mine.savefig(io.BytesIO(), format="png", dpi=40)
    assert mine.axes == [left, right]
    assert not left.has_data()
    assert right.has_data()
    assert right.get_title() + right.get_title(loc="left")
    assert dict(mpl.rcParams) == before
    with pytest.raises(ValueError, match=r"ax = .*needs matplotlib Axes, or None"):
        result.plot(ax=mine)


def test_a_trace_has_no_picture():
    def seen(angle):
        with pytest.raises(ValueError, match="AngleFit = 'a trace': needs known numbers"):
            fx.fit_angle(SURFACE, BRISTLE, ratio=angle).plot()
        return angle

    jax.jit(seen)(1.3)


def test_what_is_made_of_leaves_says_that_nothing_is_known_of_it():
    for found, needs in (
        (fx.friction(SCENE), "those that fx.friction has returned"),
        (fx.solve_limit(SCENE, STILL), "one that solve has returned"),
    ):
        copy = jax.tree_util.tree_map(lambda leaf: leaf, found)
        with pytest.raises(ValueError, match=needs):
            copy.plot()


def test_what_friction_found_does_not_keep_a_potential_alive():
    """Coefficients know their potential, and a potential its own: one of them lets go."""
    gc.freeze()  # what was there before need not be looked through: 3 s
    scene = SCENE.replace(profile=fx.profiles.Sine(0.0789))
    gone = weakref.ref(scene.potential)
    fx.friction(scene)
    del scene
    gc.collect()
    gc.unfreeze()
    assert gone() is None


def test_matplotlib_is_loaded_by_whoever_draws():
    told = """
import sys, jax
jax.config.update("jax_enable_x64", True)
import frictionjax as fx
found = fx.friction(fx.profiles.Sine(0.1), fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0))
assert "matplotlib" not in sys.modules
found.plot()
assert "matplotlib" in sys.modules
assert "matplotlib.pyplot" not in sys.modules
"""
    subprocess.run([sys.executable, "-c", told], check=True)
