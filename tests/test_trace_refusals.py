"""Traces: their files, and what `fit_trace` refuses, by name."""

import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.5),
    fx.supports.Spring(1.0),
    fx.loads.Sine(0.8, 10.0),
    10.0,
)


def test_files(tmp_path):
    path = tmp_path / "trace.csv"
    trace = fx.Trace([0.0, 0.1, 0.3, 0.4], force=[1.0, 2.0, 3.0, 4.0], uncertainty=0.1)
    trace.to_csv(path)
    again = fx.Trace.from_csv(path)
    np.testing.assert_array_equal(again.values, trace.values)
    np.testing.assert_array_equal(again.uncertainty, trace.uncertainty)
    for text, message in (
        ("t,force\n", "rows = 1"),
        ("t,force\n0,1\n1\n", "row 3 = '1 fields'"),
        ("t,force\n0,a\n", "rows: need numbers"),
        ("s,force\n0,1\n", "needs t among them"),
        ("t,height\n0,1\n", "needs force or z among them"),
    ):
        path.write_text(text)
        with pytest.raises(ValueError, match=message):
            fx.Trace.from_csv(path)
    with pytest.raises(ValueError, match="No such file"):
        fx.Trace.from_csv(tmp_path / "none.csv")


FOUR = [0.0, 1.0, 2.0, 3.0]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"ts": FOUR}, "trace = 'nothing': needs one of force and z"),
        ({"ts": FOUR, "force": FOUR, "z": FOUR}, "trace = 'force and z'"),
        ({"ts": FOUR[:3], "force": FOUR[:3]}, "4 or more times"),
        ({"ts": [0, 1, 1, 2], "z": FOUR}, "increasing times"),
        ({"ts": [-1, 1, 2, 3], "z": FOUR}, "times from 0 on"),
        ({"ts": [0, 1, np.nan, 2], "z": FOUR}, "finite times"),
        ({"ts": FOUR, "force": [0, 1, np.nan, 2]}, "trace.force = .*finite values"),
        ({"ts": FOUR, "z": FOUR[:2]}, r"trace.z = .*the shape \(4,\) of ts"),
        ({"ts": FOUR, "z": FOUR, "uncertainty": 0.0}, "uncertainties > 0"),
        ({"ts": FOUR, "z": FOUR, "uncertainty": [1, 1, np.inf, 1]}, "uncertainties > 0"),
        ({"ts": FOUR, "z": FOUR, "uncertainty": [1, 1]}, "trace.uncertainty"),
        ({"ts": FOUR, "z": "high"}, "trace.z"),
    ],
)
def test_bad_traces_are_named(arguments, message):
    with pytest.raises(ValueError, match=message):
        fx.Trace(**arguments)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"trace": None}, "trace = 'NoneType': needs a Trace"),
        ({"scene": None}, "scene = 'NoneType': needs a Scene"),
        ({"eps": 0.0}, "eps = 0: needs eps > 0"),
        ({"gamma": -1.0}, "gamma = -1: needs gamma > 0"),
        ({"within": 0.0}, "within = 0"),
        ({"harmonics": 0}, "harmonics = 0: needs a whole number"),
        ({"max_steps": 1.5}, "max_steps = 1.5"),
        ({"starts": 0}, "starts = 0: needs a whole number >= 1"),
        ({"accuracy": 1.0}, "accuracy = 1: needs"),
        ({"trace": fx.Trace([0, 1, 2, 11], z=FOUR)}, r"times in \[0, duration\]"),
    ],
)
def test_bad_arguments_are_named(options, message):
    known = {"trace": fx.Trace(FOUR, z=FOUR), "scene": SCENE, "eps": 0.05}
    with pytest.raises(ValueError, match=message):
        fx.fit_trace(**known | options)


def test_forces_that_the_support_cannot_have_are_named():
    bounded = fx.supports.Convex(lambda z: jnp.sqrt(1 + z**2))  # |Phi'| < 1
    scene = fx.Scene(SCENE.profile, SCENE.bristle, bounded, SCENE.load, 10.0)
    with pytest.raises(ValueError, match="forces that the support can have"):
        fx.fit_trace(fx.Trace(FOUR, force=[0.0, 5.0, 0.0, 0.0]), scene, 0.05)
