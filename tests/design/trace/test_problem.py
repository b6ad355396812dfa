"""Problems of fits to traces: a scene in tables, exact on all surfaces that are tried."""

import jax
import numpy as np
import pytest
from at_places import each_at_places

import frictionjax as fx
from frictionjax.design.trace.problem import in_tables
from frictionjax.tables import SeriesBristle

LOOP = fx.loads.PiecewiseLinear([0.0, 2.5, 7.5, 10.0], [0.0, 0.8, -0.8, 0.0])
ANGULAR = fx.bristles.AngularSpring(1.0, 1.2, 1.0, 0.3)


def scene_of(bristle, load=LOOP):
    spring = fx.supports.Spring(1.0)
    return fx.Scene(fx.profiles.Sine(0.05), bristle, spring, load, 10.0)


def slopes(bristle, etas):
    return each_at_places([jax.grad(bristle.offset), jax.grad(bristle.energy)], etas)


def kind(tree):
    leaves, structure = jax.tree_util.tree_flatten(tree)
    return structure, *(np.shape(leaf) for leaf in leaves)


def test_scenes_of_all_classes_are_of_one_kind():
    scenes = [
        scene_of(fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.5)),
        scene_of(ANGULAR, fx.loads.Sine(0.8, 5.0)),
        scene_of(fx.bristles.VerticalSpring(1.0, 2.0, 1.0), fx.loads.Triangle(0.8, 9.0)),
        scene_of(fx.bristles.Homothetic(-1.0), fx.loads.Ramp(0.2)),
    ]
    assert len({kind(in_tables(scene, 0.05, 4)) for scene in scenes}) == 1


def test_the_bristle_is_exact_as_high_as_slopes_that_the_contact_allows_go():
    found, limits = in_tables(scene_of(ANGULAR), 0.1, 4)
    bounds = ANGULAR.slope_bounds()
    # Of a sawtooth that rises at the one and falls at the other: half of its height.
    length = float(bounds.upper) / (float(bounds.upper) - float(bounds.lower))
    highest = 0.5 * -float(bounds.lower) * length
    assert float(limits.height) == pytest.approx(highest)
    etas = np.linspace(-0.1 * highest, 0.1 * highest, 41)
    series, own = slopes(found.bristle, etas), slopes(ANGULAR, etas)
    assert np.max(np.abs(series - own)) < 4e-14 * np.max(np.abs(own))
    assert (
        np.max(np.abs(slopes(found.bristle, 4 * etas) - slopes(ANGULAR, 4 * etas))) > 1e-6
    )


def test_a_bristle_without_a_series_that_high_stays_as_it_is():
    steep = fx.bristles.AngularSpring(1.0, 1.1, 1.0, 0.2)
    found, limits = in_tables(scene_of(steep), 0.1, 4)
    assert found.bristle is steep
    assert np.isinf(limits.height)
    assert isinstance(in_tables(scene_of(steep), 0.01, 4)[0].bristle, SeriesBristle)
